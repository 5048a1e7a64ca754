#include "calib/programs/serve_room.h"

#include <arpa/inet.h>

#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include "calib/simulate/live_room.h"
#include "devices/serve/gige_camera.h"
#include "devices/simulate/pan_tilt_simulator.h"
#include "devices/simulate/projector_simulator.h"

namespace pixelflex::calib {
namespace {

using devices::PanTiltSimulator;
using devices::ProjectorState;

constexpr std::string_view kKind = "aravis:";
constexpr std::string_view kName = "PixelFlex-Room-";
constexpr double kDegreesPerCount = 185.1428 / 3600;

/// What a programs' `source: aravis:NAME` means here: an address of this machine, a name, or a serial number.
devices::GigeCamera::Options placeOf(const std::string& source, devices::Size size) {
  devices::GigeCamera::Options options;
  options.size = size;
  std::string name = source.substr(kKind.size());
  in_addr ignored{};
  if (::inet_pton(AF_INET, name.c_str(), &ignored) == 1) {
    options.address = name;
  } else if (name != "first") {
    options.serial = name.starts_with(kName) ? name.substr(kName.size()) : name;
  }
  return options;
}

/// The way that a motor has gone since, of half its range.
double way(const ProjectorState::Motor& now, const ProjectorState::Motor& then) {
  return 2.0 * (now.place - then.place) / (then.maximum - then.minimum);
}

double ratio(int now, int then) {
  return then == 0 ? 1 : static_cast<double>(now) / then;
}

void applyState(const ProjectorState& now, const ProjectorState& then, ProjectorSetting& setting) {
  setting.zoom = way(now.lens.zoom, then.lens.zoom);
  setting.focus = way(now.lens.focus, then.lens.focus);
  setting.shift = {way(now.lens.shiftH, then.lens.shiftH), -way(now.lens.shiftV, then.lens.shiftV)};
  setting.lit = now.isOn();
  setting.muted = now.mute;
  setting.frozen = now.freeze;
  setting.brightness = 2.0 * (now.brightness - then.brightness);
  setting.contrast = ratio(now.contrast, then.contrast);
  for (std::size_t c = 0; c < 3; ++c) setting.gain.at(c) = ratio(now.gain.at(c), then.gain.at(c));
}

/// Where a projector's devices are in the host, and how they were set in the beginning.
struct Devices {
  std::string mirror;  // empty: it has none
  std::string control;
  glm::dvec2 mirrorThen{0, 0};  // counts
  ProjectorState stateThen{};
};

}  // namespace

struct ServedRoom::Impl {
  Impl(const std::filesystem::path& folder, const Wall& wall, devices::DeviceHost& deviceHost,
       const std::vector<WallDevice>& all)
      : host(deviceHost), room(loadRig(folder / *wall.rig), folder / "room") {
    for (const auto& spec : room.rig().projectors) of.push_back(devicesOf(spec.name, all));
  }

  [[nodiscard]] Devices devicesOf(const std::string& projector, const std::vector<WallDevice>& all) {
    Devices its;
    for (const auto& device : all) {
      if (device.projector != projector || device.line.at.starts_with("sim:")) continue;
      (device.isMirror ? its.mirror : its.control) = device.name;
    }
    if (!its.mirror.empty()) its.mirrorThen = countsOf(its.mirror);
    if (!its.control.empty()) its.stateThen = stateOf(its.control);
    return its;
  }
  [[nodiscard]] glm::dvec2 countsOf(const std::string& mirror) {
    glm::dvec2 counts(0);
    host.with(mirror, [&](devices::SimulatedDevice& device, auto) {
      const auto& unit = dynamic_cast<PanTiltSimulator&>(device);
      counts = {unit.motor(PanTiltSimulator::kPan).position, unit.motor(PanTiltSimulator::kTilt).position};
    });
    return counts;
  }
  [[nodiscard]] ProjectorState stateOf(const std::string& control) {
    ProjectorState state;
    host.with(control, [&](devices::SimulatedDevice& device, auto) {
      state = dynamic_cast<devices::ProjectorSimulator&>(device).state();
    });
    return state;
  }
  [[nodiscard]] std::vector<ProjectorSetting> settings() {
    std::vector<ProjectorSetting> all(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (!of[i].mirror.empty()) all[i].mirror = kDegreesPerCount * (countsOf(of[i].mirror) - of[i].mirrorThen);
      if (!of[i].control.empty()) applyState(stateOf(of[i].control), of[i].stateThen, all[i]);
    }
    return all;
  }
  void refresh() {
    const std::scoped_lock lock(mutex);
    room.set(settings());
  }
  [[nodiscard]] devices::Image8 photograph(double seconds) {
    const std::scoped_lock lock(mutex);
    room.set(settings());
    return room.photograph(seconds);
  }

  devices::DeviceHost& host;
  std::mutex mutex;  // of the room
  LiveRoom room;
  std::vector<Devices> of;  // each of the rig's projectors
  std::string address;
  std::optional<devices::GigeCamera> camera;
};

ServedRoom::ServedRoom(const std::filesystem::path& folder, const Wall& wall, devices::DeviceHost& host,
                       const std::vector<WallDevice>& devices, Say say)
    : impl_(std::make_unique<Impl>(folder, wall, host, devices)) {
  const auto place = placeOf(wall.camera.source, impl_->room.rig().camera.size);
  impl_->address = place.address;
  impl_->camera.emplace(
      place, [room = impl_.get()](double seconds) { return room->photograph(seconds); },
      [tell = std::move(say)](const std::string& what) { tell("camera: " + what); });
}

ServedRoom::~ServedRoom() = default;

std::string ServedRoom::camera() const {
  return "aravis:" + impl_->camera->name() + " at " + impl_->address;
}

void ServedRoom::refresh() {
  impl_->refresh();
}

bool hasServedCamera(const Wall& wall) {
  return wall.rig && wall.camera.source.starts_with(kKind);
}

}  // namespace pixelflex::calib
