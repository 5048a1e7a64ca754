#include "calib/simulate/room_folder.h"

#include <algorithm>
#include <array>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using devices::Image8;
using devices::Scene;

constexpr std::array<std::string_view, 3> kSceneNames = {"light", "dark", "checkerboard"};  // in the order of Scene

std::string contentsOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class FileProjector final : public devices::Projector {
 public:
  FileProjector(const SimulatedProjectorSpec& spec, const fs::path& folder)
      : name_(spec.name), resolution_(spec.resolution), file_(folder / (spec.name + ".png")) {
    FileProjector::blank();
  }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] devices::Size resolution() const override { return resolution_; }
  void show(const Image8& frame) override {
    if (frame.size() != resolution_) throw std::invalid_argument("projector " + name_ + ": a frame of another size");
    devices::writePng(file_, frame);
  }
  void blank() override { fs::remove(file_); }

 private:
  std::string name_;
  devices::Size resolution_;
  fs::path file_;
};

class FilePerson final : public devices::Operator {
 public:
  FilePerson(fs::path file, int poses, int places) : file_(std::move(file)), poses_(poses), places_(places) {}
  [[nodiscard]] bool arrange(Scene scene, int index) override {
    if (scene == Scene::kCheckerboard && index >= poses_) return false;
    scene_.scene = scene;
    scene_.index = index;
    write();
    return true;
  }
  [[nodiscard]] bool placeCamera(int place) override {
    if (place < 0 || place >= places_) return false;
    scene_.place = place;
    write();
    return true;
  }
  void write() const {
    std::ostringstream text;
    text << kSceneNames.at(static_cast<std::size_t>(scene_.scene)) << ' ' << scene_.index << ' ' << scene_.place
         << '\n';
    devices::writeFileAtomically(file_, text.str());
  }

 private:
  fs::path file_;
  int poses_;
  int places_;
  RoomScene scene_;
};

/// A dark room where nobody has said anything else.
RoomScene sceneIn(const std::string& text) {
  std::istringstream stream(text);
  std::string name;
  RoomScene scene;
  stream >> name >> scene.index >> scene.place;
  const auto found = std::ranges::find(kSceneNames, name);
  if (!stream || found == kSceneNames.end()) return {};
  scene.scene = static_cast<Scene>(found - kSceneNames.begin());
  return scene;
}

}  // namespace

struct PublishedRoom::Impl {
  Impl(const fs::path& folder, const Rig& rig)
      : person(folder / "room.txt", rig.checkerboardPoses, static_cast<int>(rig.cameraPlaces.size()) + 1) {
    fs::create_directories(folder);
    for (const auto& spec : rig.projectors) projectors.push_back(std::make_unique<FileProjector>(spec, folder));
    person.write();
  }
  std::vector<std::unique_ptr<FileProjector>> projectors;
  FilePerson person;
};

PublishedRoom::PublishedRoom(fs::path folder, const Rig& rig) : impl_(std::make_unique<Impl>(folder, rig)) {}

PublishedRoom::~PublishedRoom() {
  try {
    for (const auto& projector : impl_->projectors) projector->blank();
  } catch (const std::exception&) {  // a folder that is gone shows nothing
  }
}

std::vector<devices::Projector*> PublishedRoom::projectors() const {
  std::vector<devices::Projector*> all;
  for (const auto& projector : impl_->projectors) all.push_back(projector.get());
  return all;
}

devices::Operator& PublishedRoom::person() const {
  return impl_->person;
}

RoomFolder::RoomFolder(fs::path folder, const Rig& rig) : folder_(std::move(folder)) {
  for (const auto& spec : rig.projectors) shown_.push_back({spec.name, spec.resolution, {}, {}});
}

std::vector<std::size_t> RoomFolder::look() {
  scene_ = sceneIn(contentsOf(folder_ / "room.txt"));
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    Shown& shown = shown_[i];
    const fs::path file = folder_ / (shown.name + ".png");
    std::string bytes = contentsOf(file);
    if (bytes == shown.bytes) continue;
    Image8 frame = bytes.empty() ? Image8() : devices::readPng8(file);
    if (!frame.empty() && (frame.size() != shown.resolution || frame.channels() == 2)) {
      throw std::runtime_error(file.string() + ": not a picture of " + shown.name + "'s resolution");
    }
    shown.bytes = std::move(bytes);
    shown.frame = std::move(frame);
    changed.push_back(i);
  }
  return changed;
}

}  // namespace pixelflex::calib
