#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "calib/store/wall.h"
#include "devices/image/image.h"

namespace pixelflex::viewer {

/// What the camera saw last.
struct CameraPicture {
  std::uint64_t number = 0;           // counts from 1; 0: nothing yet
  devices::Image8 photo;              // three channels, no wider than kMostWidth
  devices::Size size;                 // of the photograph itself
  std::map<int, glm::dvec2> markers;  // ArUco id to its centre, in pixels of the photograph itself
  double seconds = 0;                 // from the request to the picture
  std::string trouble;                // in the picture's stead: why there is none
};

/// The wall's camera, photographing again and again while somebody looks, on a thread of its own. Thread-safe.
class CameraFeed {
 public:
  static constexpr int kMostWidth = 1280;

  CameraFeed(std::filesystem::path folder, std::shared_ptr<const calib::Wall> wall);
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  /// The camera is opened when wanted, and closed again when not.
  void want(bool wanted);
  /// Not wanted, and others may use the camera.
  [[nodiscard]] bool isClosed() const;
  /// Never null.
  [[nodiscard]] std::shared_ptr<const CameraPicture> latest() const;
  /// What a projector of a simulated wall shows from now on.
  void showInRoom(const std::string& projector, devices::Image8 frame);

 private:
  class Source;
  void run(const std::stop_token& stop);
  [[nodiscard]] bool waitUntilWanted(const std::stop_token& stop, std::unique_ptr<Source>& source);
  [[nodiscard]] std::shared_ptr<CameraPicture> shoot(Source& source);

  std::filesystem::path folder_;
  std::shared_ptr<const calib::Wall> wall_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  bool wanted_ = false;
  bool open_ = false;
  std::map<std::string, std::shared_ptr<const devices::Image8>> frames_;  // of the simulated room
  std::shared_ptr<const CameraPicture> latest_ = std::make_shared<const CameraPicture>();
  std::jthread thread_;
};

}  // namespace pixelflex::viewer
