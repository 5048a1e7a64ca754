#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "calib/capture/capture_folder.h"
#include "calib/capture/photographs.h"
#include "devices/camera/camera.h"
#include "devices/camera/operator.h"
#include "devices/projector/projector.h"

namespace pixelflex::calib {

/// Writes PNG files on a thread of its own so that the next photograph need not wait; at most four are queued.
class PhotoWriter {
 public:
  PhotoWriter();
  ~PhotoWriter();
  PhotoWriter(const PhotoWriter&) = delete;
  PhotoWriter& operator=(const PhotoWriter&) = delete;
  void write(std::filesystem::path file, devices::Image8 photo);
  /// Waits for the last file; throws what a write threw.
  void finish();

 private:
  void run(const std::stop_token& stop);
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<std::pair<std::filesystem::path, devices::Image8>> queue_;
  bool writing_ = false;
  std::exception_ptr error_;
  std::jthread thread_;
};

/// Photographs taken now: shows each pattern on its projector with all others black, through the device interfaces.
/// The projectors are black again when this ends, whatever happened.
class LivePhotographs : public Photographs {
 public:
  /// The devices must outlive this. `identity` describes the set-up for stamp(). Photographs are gathered beside
  /// `captures` as they are taken (CaptureFolder) and move there in keep(); nowhere when it is empty.
  LivePhotographs(devices::Camera& camera, std::vector<devices::Projector*> projectors, devices::Operator& person,
                  std::filesystem::path captures, std::string identity, int checkerboardCount, int placeCount = 1);
  ~LivePhotographs() override;
  LivePhotographs(const LivePhotographs&) = delete;
  LivePhotographs& operator=(const LivePhotographs&) = delete;

  [[nodiscard]] int placeCount() const override { return placeCount_; }
  /// Asks the person to move the camera unless it stands there; throws CaptureError when they cannot.
  void choosePlace(int place) override;
  [[nodiscard]] std::optional<Named> nextCheckerboard() override;
  [[nodiscard]] int checkerboardCount() const override { return checkerboardCount_; }
  [[nodiscard]] Named fiducials() override;
  [[nodiscard]] bool hasProjector(const std::string& projector) override { return find(projector) != nullptr; }
  [[nodiscard]] devices::Image8 pattern(const std::string& projector, const ProjectedPattern& pattern) override;
  [[nodiscard]] std::optional<devices::ExposureRange> exposureRange() override;
  [[nodiscard]] double usualExposure() override;
  [[nodiscard]] Exposed exposed(const std::string& projector, const ProjectedPattern& pattern, double seconds,
                                const PictureRegion& region) override;
  [[nodiscard]] std::string stamp(const std::string& kind) const override;
  void keep(Kept what) override;

 private:
  [[nodiscard]] devices::Projector* find(const std::string& name) const;
  void blankAll();
  void showInTheDark(const std::string& projector, const ProjectedPattern& pattern);
  void darken();
  void expose(std::optional<double> seconds);
  [[nodiscard]] Named shoot(const std::filesystem::path& relative);
  [[nodiscard]] devices::Image8 readAgain(const std::filesystem::path& file);

  devices::Camera& camera_;
  std::vector<devices::Projector*> projectors_;
  devices::Operator& person_;
  std::optional<CaptureFolder> captures_;
  /// What was photographed already, by place and relative path: asked for again, it is the same photograph.
  std::map<std::pair<int, std::filesystem::path>, std::filesystem::path> taken_;
  std::string identity_;
  int checkerboardCount_;
  int placeCount_;
  int place_ = 0;
  int nextCheckerboard_ = 0;
  bool dark_ = false;
  devices::Projector* lit_ = nullptr;
  std::string shown_;            // the pattern on it
  std::optional<double> usual_;  // exposure in seconds, while another one is set
  PhotoWriter writer_;
};

}  // namespace pixelflex::calib
