#include "viewer/model/scene_pictures.h"

#include <assimp/scene.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"
#include "devices/image/png_file.h"
#include "viewer/model/model_folder.h"

namespace pixelflex::viewer {
namespace {

/// A file of this process alone, with bytes that only readers of files understand.
class MemoryFile {
 public:
  MemoryFile(const void* bytes, std::size_t count) : descriptor_(::memfd_create("picture", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || ::write(descriptor_, bytes, count) != static_cast<ssize_t>(count)) {
      close();
      throw devices::ImageError("a picture inside the model cannot be unpacked");
    }
  }
  ~MemoryFile() { close(); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  void close() const {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int descriptor_;
};

/// Three channels, or four where a PNG has opacity.
devices::Image8 readFile(const std::filesystem::path& path) {
  std::array<char, 4> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  if (std::string_view(start.data(), start.size()) != "\x89PNG") return devices::readPhoto(path);
  devices::Image8 read = devices::readPng8(path);
  if (read.channels() > 2) return read;
  devices::Image8 picture(read.size(), read.channels() + 2);
  for (int y = 0; y < read.height(); ++y) {
    for (int x = 0; x < read.width(); ++x) {
      for (int c = 0; c < picture.channels(); ++c) picture.at(x, y, c) = read.at(x, y, c < 3 ? 0 : 1);
    }
  }
  return picture;
}

/// `opacity`: its fourth channel, else its brightness.
devices::Image8 withOpacity(const devices::Image8& colour, const devices::Image8& opacity) {
  if (colour.size() != opacity.size()) throw devices::ImageError("its opacity is a picture of another size");
  devices::Image8 both(colour.size(), 4);
  for (int y = 0; y < colour.height(); ++y) {
    for (int x = 0; x < colour.width(); ++x) {
      for (int c = 0; c < 3; ++c) both.at(x, y, c) = colour.at(x, y, c);
      both.at(x, y, 3) = opacity.at(x, y, opacity.channels() == 4 && letsSeeThrough(opacity) ? 3 : 0);
    }
  }
  return both;
}

devices::Image8 embedded(const aiTexture& texture) {
  if (texture.mHeight == 0) return readFile(MemoryFile(texture.pcData, texture.mWidth).path());
  if (std::max(texture.mWidth, texture.mHeight) > static_cast<unsigned>(kLargestPicture)) {
    throw devices::ImageError("larger than 16384 pixels");
  }
  devices::Image8 picture({static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight)}, 4);
  const aiTexel* from = texture.pcData;
  for (std::size_t i = 0; i < picture.samples().size(); i += 4, ++from) {
    picture.samples()[i] = from->r;
    picture.samples()[i + 1] = from->g;
    picture.samples()[i + 2] = from->b;
    picture.samples()[i + 3] = from->a;
  }
  return picture;
}

}  // namespace

bool letsSeeThrough(const devices::Image8& picture) {
  if (picture.channels() < 4) return false;
  for (std::size_t i = 3; i < picture.samples().size(); i += 4) {
    if (picture.samples()[i] < 255) return true;
  }
  return false;
}

bool isCutOut(const devices::Image8& picture) {
  constexpr int kSure = 8;
  std::size_t between = 0;
  for (std::size_t i = 3; i < picture.samples().size(); i += 4) {
    between += picture.samples()[i] > kSure && picture.samples()[i] < 255 - kSure ? 1 : 0;
  }
  return between < picture.samples().size() / 4 / 10;
}

int ScenePictures::of(const aiMaterial& material) {
  aiString opacity;
  if (material.GetTexture(aiTextureType_OPACITY, 0, &opacity) != AI_SUCCESS) opacity.Clear();
  for (const auto type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    aiString name;
    if (material.GetTexture(type, 0, &name) != AI_SUCCESS || name.length == 0) continue;
    return numberOf(name.C_Str(), opacity.C_Str());
  }
  return -1;
}

int ScenePictures::numberOf(const std::string& name, const std::string& opacity) {
  const auto known = known_.find({name, opacity});
  if (known != known_.end()) return known->second;
  return known_[{name, opacity}] = load(name, opacity);
}

int ScenePictures::load(const std::string& name, const std::string& opacity) {
  try {
    auto picture = checked(name);
    if (!opacity.empty() && !(opacity == name && letsSeeThrough(picture))) {
      picture = withOpacity(picture, checked(opacity));
    }
    into_.pictures.push_back(std::move(picture));
    return static_cast<int>(into_.pictures.size()) - 1;
  } catch (const devices::ImageError& error) {
    into_.warnings.push_back(file_.string() + ": the picture " + name + " is left out: " + error.what());
    return -1;
  }
}

devices::Image8 ScenePictures::checked(const std::string& name) const {
  auto picture = read(name);
  if (std::max(picture.width(), picture.height()) > kLargestPicture) {
    throw devices::ImageError("larger than 16384 pixels");
  }
  return picture;
}

devices::Image8 ScenePictures::read(const std::string& name) const {
  if (const aiTexture* inside = from_.GetEmbeddedTexture(name.c_str())) return embedded(*inside);
  return readFile(besideModel(file_, name));
}

}  // namespace pixelflex::viewer
