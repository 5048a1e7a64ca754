#include "viewer/model/scene_pictures.h"

#include <assimp/scene.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

#include "devices/image/image_error.h"
#include "devices/image/photo_file.h"

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

devices::Image8 embedded(const aiTexture& texture) {
  if (texture.mHeight == 0) return devices::readPhoto(MemoryFile(texture.pcData, texture.mWidth).path());
  if (std::max(texture.mWidth, texture.mHeight) > static_cast<unsigned>(kLargestPicture)) {
    throw devices::ImageError("larger than 16384 pixels");
  }
  devices::Image8 picture({static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight)}, 3);
  const aiTexel* from = texture.pcData;
  for (std::size_t i = 0; i < picture.samples().size(); i += 3, ++from) {
    picture.samples()[i] = from->r;
    picture.samples()[i + 1] = from->g;
    picture.samples()[i + 2] = from->b;
  }
  return picture;
}

}  // namespace

int ScenePictures::of(const aiMaterial& material) {
  for (const auto type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    aiString name;
    if (material.GetTexture(type, 0, &name) != AI_SUCCESS || name.length == 0) continue;
    const auto known = known_.find(name.C_Str());
    if (known != known_.end()) return known->second;
    return known_[name.C_Str()] = load(name.C_Str());
  }
  return -1;
}

int ScenePictures::load(const std::string& name) {
  try {
    auto picture = read(name);
    if (std::max(picture.width(), picture.height()) > kLargestPicture) {
      throw devices::ImageError("larger than 16384 pixels");
    }
    into_.pictures.push_back(std::move(picture));
    return static_cast<int>(into_.pictures.size()) - 1;
  } catch (const devices::ImageError& error) {
    into_.warnings.push_back(file_.string() + ": the picture " + name + " is left out: " + error.what());
    return -1;
  }
}

devices::Image8 ScenePictures::read(const std::string& name) const {
  if (const aiTexture* inside = from_.GetEmbeddedTexture(name.c_str())) return embedded(*inside);
  std::string path = name;
  std::ranges::replace(path, '\\', '/');
  return devices::readPhoto(file_.parent_path() / path);
}

}  // namespace pixelflex::viewer
