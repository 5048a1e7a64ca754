#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/image/image.h"
#include "viewer/panel/panel_context.h"
#include "viewer/panel/test_picture_images.h"

namespace pixelflex::viewer {

/// Test pictures on the projectors' outputs: each in a window of a program of its own (`pixelflex panel WALL --show`),
/// on the display that its output names; those of a simulated wall in its room. Main thread.
class TestPictures {
 public:
  /// `inRoom` shows a frame of a simulated projector. `programs`: where pixelflex-panel is.
  using InRoom = std::function<void(const std::string& projector, devices::Image8 frame)>;
  TestPictures(InRoom inRoom, std::filesystem::path programs)
      : inRoom_(std::move(inRoom)), programs_(std::move(programs)) {}

  void show(PanelContext& panel, const std::vector<std::string>& projectors, const std::string& picture);
  /// "off" when there is none.
  [[nodiscard]] std::string shownOn(const std::string& projector) const;
  /// Where a projector's pictures appear, in words.
  [[nodiscard]] std::string whereIs(const PanelContext& panel, const std::string& projector) const;

 private:
  struct Shown {
    std::string picture;
    std::shared_ptr<std::atomic<bool>> ended = std::make_shared<std::atomic<bool>>(false);
    std::jthread thread;  // waits for the program; none for simulated projectors
  };
  void end(const std::string& projector);
  void showOne(PanelContext& panel, const calib::ProjectorConfig& projector, const std::string& picture);
  void startProgram(PanelContext& panel, Shown& shown, const std::string& projector);

  InRoom inRoom_;
  std::filesystem::path programs_;
  std::map<std::string, Shown> shown_;
  std::vector<Shown> ending_;
};

}  // namespace pixelflex::viewer
