#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "calib/store/store.h"
#include "devices/serve/device_host.h"
#include "devices/simulate/pan_tilt_simulator.h"
#include "devices/simulate/projector_simulator.h"
#include "devices/simulate/simulators.h"
#include "tests/e2e/programs.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// Projectors with a control and a mirror each, every one behind a TCP port of its own.
class DeviceRoomTest : public ::testing::Test {
 protected:
  void makeRoom(int projectors, double speedFactor = 1) {
    calib::Wall wall;
    wall.camera.source = "none";
    for (int i = 0; i < projectors; ++i) {
      calib::ProjectorConfig projector;
      projector.name = "p" + std::to_string(i + 1);
      projector.resolution = {1024, 768};
      projector.flatAt = {1024 * i, 0};
      host_.add(projector.name + ".control", devices::makeSimulator("proxima-dp6850"));
      host_.add(projector.name + ".mirror", std::make_unique<devices::PanTiltSimulator>(
                                                devices::PanTiltSimulator::Options{.speedFactor = speedFactor}));
      projector.control = {"proxima-dp6850", host_.address(projector.name + ".control"), {}};
      projector.mirror = {"ptu", host_.address(projector.name + ".mirror"), {}};
      wall.projectors.push_back(projector);
    }
    std::filesystem::create_directory(folder());
    saveWall(folder(), wall);
  }

  [[nodiscard]] std::string folder() const { return (folder_ / "wall").string(); }
  [[nodiscard]] Output device(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), folder());
    return runProgram("device", arguments);
  }
  [[nodiscard]] devices::ProjectorState projector(const std::string& control) {
    devices::ProjectorState state;
    host_.with(control, [&](devices::SimulatedDevice& device, auto) {
      state = dynamic_cast<devices::ProjectorSimulator&>(device).state();
    });
    return state;
  }
  [[nodiscard]] devices::PanTiltSimulator::Motor pan(const std::string& mirror) {
    devices::PanTiltSimulator::Motor motor;
    host_.with(mirror, [&](devices::SimulatedDevice& unit, auto) {
      motor = dynamic_cast<devices::PanTiltSimulator&>(unit).motor(devices::PanTiltSimulator::kPan);
    });
    return motor;
  }
  [[nodiscard]] bool moves(const std::string& mirror) {
    bool moving = false;
    host_.with(mirror, [&](devices::SimulatedDevice& unit, auto) {
      moving = dynamic_cast<devices::PanTiltSimulator&>(unit).isMoving();
    });
    return moving;
  }
  /// Within a generous time.
  [[nodiscard]] bool comesTo(bool moving, const std::string& mirror) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (moves(mirror) != moving) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

  TemporaryFolder folder_;
  devices::DeviceHost host_;
};

}  // namespace pixelflex::testing
