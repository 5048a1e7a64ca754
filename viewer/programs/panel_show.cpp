#include "viewer/programs/panel_show.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "calib/store/store.h"
#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"
#include "devices/display/window_projector.h"
#include "devices/image/png_file.h"
#include "viewer/panel/test_picture_images.h"
#include "viewer/programs/quit_signal.h"

namespace pixelflex::viewer {
namespace {

using calib::OutputKind;

std::vector<calib::ProjectorConfig> chosen(const calib::Wall& wall, const std::vector<std::string>& names) {
  std::vector<calib::ProjectorConfig> projectors;
  for (const auto& name : names) {
    const auto found = std::ranges::find(wall.projectors, name, &calib::ProjectorConfig::name);
    if (found == wall.projectors.end()) throw std::runtime_error("\"" + name + "\" is no projector of this wall");
    const OutputKind kind = found->output.kind;
    if (kind == OutputKind::kNone) {
      throw std::runtime_error(name + ": wall.yaml gives it no monitor or display, so nothing can be shown");
    }
    projectors.push_back(*found);
  }
  return projectors;
}

bool isSimulated(const calib::ProjectorConfig& projector) {
  return projector.output.kind == OutputKind::kSim;
}

std::optional<std::string> displayOf(const calib::ProjectorConfig& projector) {
  if (projector.output.kind == OutputKind::kDisplay) return projector.output.display;
  return std::nullopt;
}

glm::ivec2 placeOf(const devices::EventLoop& loop, const calib::Output& output) {
  return output.kind == OutputKind::kDisplay ? output.at : devices::findMonitor(loop, output.monitor).position;
}

/// What a simulated projector shows to a room that another program serves, as long as this lives.
class RoomPicture {
 public:
  RoomPicture(const std::filesystem::path& wall, const calib::ProjectorConfig& projector,
              const devices::Image8& picture)
      : file_(wall / "room" / (projector.name + ".png")) {
    std::filesystem::create_directories(file_.parent_path());
    devices::writePng(file_, picture, devices::PngEffort::kFast);
  }
  ~RoomPicture() {
    std::error_code gone;
    std::filesystem::remove(file_, gone);
  }
  RoomPicture(const RoomPicture&) = delete;
  RoomPicture& operator=(const RoomPicture&) = delete;

 private:
  std::filesystem::path file_;
};

bool inputEnds() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return false;
  std::array<char, 256> bytes{};
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  return count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN);
}

void showInWindows(const std::vector<calib::ProjectorConfig>& projectors, const std::string& picture, bool untilEof) {
  const auto display = displayOf(projectors.front());
  for (const auto& projector : projectors) {
    if (displayOf(projector) == display) continue;
    throw std::runtime_error(projector.name + " and " + projectors.front().name +
                             " are on different X displays: show the picture on one after the other");
  }
  std::atomic<bool> over = false;
  // Before the threads of the graphics driver.
  const QuitSignal quit([&over] {
    over = true;
    devices::EventLoop::wake();
  });
  devices::EventLoop loop(display);
  std::vector<std::unique_ptr<devices::WindowProjector>> windows;
  for (const auto& projector : projectors) {
    auto& window = windows.emplace_back(std::make_unique<devices::WindowProjector>(
        projector.name, loop, projector.resolution, placeOf(loop, projector.output)));
    window->show(drawTestPicture(picture, projector.name, projector.resolution));
  }
  while (!over && !(untilEof && inputEnds())) loop.wait(std::chrono::seconds(1));
}

void showInRoom(const std::filesystem::path& folder, const std::vector<calib::ProjectorConfig>& projectors,
                const std::string& picture, bool untilEof) {
  std::atomic<bool> over = false;
  const QuitSignal quit([&over] { over = true; });
  std::vector<std::unique_ptr<RoomPicture>> shown;
  for (const auto& projector : projectors) {
    shown.push_back(std::make_unique<RoomPicture>(folder, projector,
                                                  drawTestPicture(picture, projector.name, projector.resolution)));
  }
  while (!over && !(untilEof && inputEnds())) std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

}  // namespace

void showTestPicture(const std::filesystem::path& folder, const std::vector<std::string>& names,
                     const std::string& picture, bool untilEof) {
  const auto projectors = chosen(calib::loadWall(folder), names);
  if (std::ranges::all_of(projectors, isSimulated)) return showInRoom(folder, projectors, picture, untilEof);
  if (std::ranges::any_of(projectors, isSimulated)) {
    throw std::runtime_error("some are simulated and some are not: show the picture on one kind after the other");
  }
  showInWindows(projectors, picture, untilEof);
}

}  // namespace pixelflex::viewer
