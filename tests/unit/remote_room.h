#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "tests/e2e/device_room.h"
#include "tests/support/tcp_talk.h"
#include "viewer/control/wall_console.h"
#include "viewer/remote/remote_control.h"

namespace pixelflex::testing {

/// A wall of simulated devices with its remote controls.
class RemoteRoomTest : public DeviceRoomTest {
 protected:
  using Json = nlohmann::json;

  /// As makeRoom(), with projectors that speak PJLink and tell more.
  void makePjlinkRoom(int projectors) {
    makeRoom(projectors, 20);
    calib::Wall wall = calib::loadWall(folder());
    for (auto& projector : wall.projectors) {
      const std::string name = projector.name + ".lamp";
      host_.add(name, devices::makePjlinkSimulator({}));
      projector.control = {"pjlink", host_.address(name), {}};
    }
    saveWall(folder(), wall);
  }
  void changeProjector(const std::string& control, const std::function<void(devices::ProjectorState&)>& change) {
    host_.with(control, [&](devices::SimulatedDevice& device, auto) {
      change(dynamic_cast<devices::ProjectorSimulator&>(device).state());
    });
  }

  void serve(const viewer::RemoteControlOptions& options, std::chrono::milliseconds pollEvery = kPollEvery) {
    console_.emplace(folder(), viewer::WallConsoleOptions{.pollEvery = pollEvery, .programs = folder_.path()});
    control_ = std::make_unique<viewer::RemoteControl>(*console_, options);
    ASSERT_TRUE(comes([](const auto& wall) {
      return std::ranges::all_of(
          wall.devices, [](const auto& device) { return device->contact == viewer::DeviceState::Contact::kWell; });
    }));
  }

  /// Within a generous time.
  [[nodiscard]] static bool eventually(const std::function<bool()>& wanted) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!wanted()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  [[nodiscard]] bool comes(const std::function<bool(const viewer::WallSnapshot&)>& wanted) const {
    return eventually([&] { return wanted(*console_->snapshot()); });
  }

  static constexpr std::chrono::milliseconds kPollEvery{20};
  std::optional<viewer::WallConsole> console_;
  std::unique_ptr<viewer::RemoteControl> control_;
};

}  // namespace pixelflex::testing
