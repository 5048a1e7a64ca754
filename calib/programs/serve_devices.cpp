#include "calib/programs/serve_devices.h"

#include <csignal>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "calib/programs/serve_room.h"
#include "calib/store/store.h"
#include "calib/store/wall_devices.h"
#include "devices/serve/device_host.h"
#include "devices/simulate/pan_tilt_simulator.h"
#include "devices/simulate/projector_simulator.h"
#include "devices/simulate/simulators.h"
#include "devices/transport/line_address.h"

namespace pixelflex::calib {
namespace {

using devices::LineKind;

std::unique_ptr<devices::SimulatedDevice> simulatorOf(const WallDevice& device, double faster) {
  if (device.isMirror) {
    return std::make_unique<devices::PanTiltSimulator>(devices::PanTiltSimulator::Options{.speedFactor = faster});
  }
  const std::string password = passwordOf(device);
  if (device.line.driver == "pjlink") return devices::makePjlinkSimulator({.password = password});
  if (device.line.driver == "hitachi-beef") {
    const bool network = device.line.at.ends_with(":9715");
    return devices::makeHitachiBeefSimulator({.network = network, .password = network ? password : ""});
  }
  return devices::makeSimulator(device.line.driver);
}

devices::LineAddress placeOf(const WallDevice& device) {
  auto address = devices::parseLineAddress(device.line.at);
  const bool ours = address.host == "127.0.0.1" || address.host == "::1" || address.host == "localhost";
  if (address.kind == LineKind::kSerial || (address.kind == LineKind::kTcp && ours)) return address;
  throw std::runtime_error(device.name + ": " + device.line.at +
                           " is no place of this machine: for a simulated one write tcp://127.0.0.1:PORT or "
                           "serial:FILE, or a simulated wall (rig: FILE) the camera source aravis:first");
}

void orderFault(devices::DeviceHost& host, const std::string& text) {
  const auto equals = text.find('=');
  const auto fault = equals == std::string::npos ? std::nullopt : devices::faultOfName(text.substr(equals + 1));
  if (!fault) {
    throw std::runtime_error("--fault " + text +
                             ": write NAME.mirror=FAULT or NAME.control=FAULT, FAULT being drop, garble, slow, silent, "
                             "stuck, busy or cut");
  }
  host.order(text.substr(0, equals), *fault);
}

}  // namespace

void serveDevices(const ServeRequest& request, const std::function<void(const std::string& line)>& say) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM}) sigaddset(&signals, number);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  devices::DeviceHost host;
  int served = 0;
  const Wall wall = loadWall(request.wall);
  const auto all = devicesOf(wall, request.wall);
  for (const auto& device : all) {
    if (device.line.at.starts_with("sim:")) {
      say(device.name + "  " + device.line.driver + "  " + device.line.at + " (within each program)");
      continue;
    }
    host.add(device.name, simulatorOf(device, request.faster), placeOf(device));
    say(device.name + "  " + device.line.driver + "  " + host.address(device.name));
    ++served;
  }
  std::optional<ServedRoom> room;
  if (hasServedCamera(wall)) {
    room.emplace(request.wall, wall, host, all, say);
    say("camera  gige  " + room->camera());
    ++served;
  }
  if (served == 0) {
    throw std::runtime_error(
        (request.wall / "wall.yaml").string() +
        ": there is nothing to serve: give projectors a control or a mirror at tcp://127.0.0.1:PORT "
        "or serial:FILE");
  }
  for (const auto& fault : request.faults) orderFault(host, fault);
  say("serving " + std::to_string(served) + (served == 1 ? " device" : " devices") + "; Ctrl+C ends it");
  const timespec betweenLooks{.tv_sec = 0, .tv_nsec = 200'000'000};
  while (sigtimedwait(&signals, nullptr, &betweenLooks) < 0) {
    if (room) room->refresh();
  }
}

}  // namespace pixelflex::calib
