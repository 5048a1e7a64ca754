// pixelflex simulate WALL: composes projector frames into what the audience of a simulated wall sees; or serves the
// wall's devices, simulated, where real ones would be.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/programs/serve_devices.h"
#include "calib/simulate/hand_aimed.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "devices/image/png_file.h"

namespace {

namespace fs = std::filesystem;
using pixelflex::calib::SimulatedWall;
using pixelflex::calib::WallRect;
using pixelflex::devices::Image8;
using pixelflex::devices::Size;

constexpr int kDefaultWidth = 2400;
constexpr int kLargestPicture = 16384;

struct Request {
  fs::path wall;
  fs::path frames;        // a folder, or empty
  fs::path uncalibrated;  // a picture of the desktop, or empty
  fs::path audience;
  std::string size;
  double margin = 6;  // per cent of the display rectangle's larger side
  bool serves = false;
  std::vector<std::string> faults;
  double faster = 1;
};

std::optional<Size> sizeOf(const std::string& text) {
  Size size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%c", &size.width, &size.height, &rest) != 2) return std::nullopt;
  const auto [low, high] = std::minmax(size.width, size.height);
  if (low < 16 || high > kLargestPicture) return std::nullopt;
  return size;
}

std::optional<WallRect> displayOf(const fs::path& wall) {
  if (!pixelflex::calib::hasCalibration(wall)) return std::nullopt;
  const auto display = pixelflex::calib::loadCalibration(wall).display;
  if (!display) return std::nullopt;
  return WallRect{{display->left, display->top}, {display->right, display->bottom}};
}

/// The part of the wall that the picture shows.
WallRect pictureRect(const SimulatedWall& wall, const std::optional<WallRect>& display, double marginPercent) {
  const auto& rig = wall.rig();
  if (!display) return {rig.screenTopLeft, rig.screenTopLeft + rig.screenSize};
  const glm::dvec2 extent = display->bottomRight - display->topLeft;
  const double margin = marginPercent / 100 * std::max(extent.x, extent.y);
  return {display->topLeft - margin, display->bottomRight + margin};
}

/// Wider or higher where needed, about the same middle, so that the picture's pixels are square on the wall.
WallRect fitted(WallRect rect, Size size) {
  const glm::dvec2 middle = 0.5 * (rect.topLeft + rect.bottomRight);
  const glm::dvec2 extent = rect.bottomRight - rect.topLeft;
  const double scale = std::max(extent.x / size.width, extent.y / size.height);
  const glm::dvec2 half = 0.5 * scale * glm::dvec2(size.width, size.height);
  return {middle - half, middle + half};
}

Size defaultSize(const WallRect& rect) {
  const glm::dvec2 extent = rect.bottomRight - rect.topLeft;
  const double scale = std::min(kDefaultWidth / extent.x, 2.0 * kDefaultWidth / extent.y);
  return {std::max(16, static_cast<int>(std::lround(scale * extent.x))),
          std::max(16, static_cast<int>(std::lround(scale * extent.y)))};
}

/// A frame as the wall takes it: three channels.
Image8 readFrame(const fs::path& file, Size resolution) {
  const Image8 image = pixelflex::devices::readPng8(file);
  if (image.size() != resolution) {
    throw std::runtime_error(
        fmt::format("{}: this frame has {}x{} pixels, but the projector has {}x{}: use the frames of "
                    "this wall",
                    file.string(), image.width(), image.height(), resolution.width, resolution.height));
  }
  Image8 frame(image.size(), 3);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      for (int c = 0; c < 3; ++c) frame.at(x, y, c) = image.at(x, y, image.channels() < 3 ? 0 : c);
    }
  }
  return frame;
}

std::vector<Image8> readFrames(const SimulatedWall& wall, const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(folder.string() +
                             ": no such folder; pixelflex view --screenshot writes the projectors' frames");
  }
  std::vector<Image8> frames;
  for (const auto& projector : wall.rig().projectors) {
    const fs::path file = folder / (projector.name + ".png");
    if (fs::exists(file)) {
      frames.push_back(readFrame(file, projector.resolution));
    } else {
      std::cerr << "pixelflex-simulate: warning: " << file.string() << " is missing: " << projector.name
                << " is shown black\n";
      frames.emplace_back();
    }
  }
  return frames;
}

/// Of a room that is served (ServedRoom): as its devices are set, beside the frames.
pixelflex::calib::Rig rigOf(const fs::path& folder, const fs::path& frames) {
  if (const fs::path now = frames / "rig.yaml"; !frames.empty() && fs::exists(now))
    return pixelflex::calib::loadRig(now);
  const auto wall = pixelflex::calib::loadWall(folder);
  if (!wall.rig) {
    throw std::runtime_error(
        (folder / "wall.yaml").string() +
        ": this wall is not simulated; name its optics with \"rig: FILE\", or make one with pixelflex "
        "new WALL --rig FILE");
  }
  return pixelflex::calib::loadRig(folder / *wall.rig);
}

void simulate(const Request& request) {
  const SimulatedWall wall(rigOf(request.wall, request.frames));
  const auto display = displayOf(request.wall);
  const auto frames =
      request.uncalibrated.empty()
          ? readFrames(wall, request.frames)
          : handAimedFrames(wall, pixelflex::devices::readPng8(request.uncalibrated), display.value_or(litRect(wall)));
  const WallRect rect = pictureRect(wall, display, request.margin);
  const Size size = sizeOf(request.size).value_or(defaultSize(rect));
  const WallRect shown = fitted(rect, size);
  pixelflex::devices::writePng(request.audience, wall.audience(frames, shown.topLeft, shown.bottomRight, size));
}

void defineOptions(CLI::App& app, Request& request) {
  app.add_option("WALL", request.wall, "The wall's folder; its wall.yaml names a rig")->required();
  auto* from = app.add_option_group("what is simulated");
  auto* frames =
      from->add_option("--frames", request.frames,
                       "Folder of frames, NAME.png for each projector; WALL/room is what a served room shows");
  auto* desktop =
      from->add_option("--uncalibrated", request.uncalibrated, "Picture of the desktop, shown as if never calibrated");
  auto* serves =
      from->add_flag("--serve", request.serves,
                     "Opens simulated devices where wall.yaml says that controls and mirrors are, and a GigE Vision "
                     "camera where its source is aravis:, all in one room, until Ctrl+C");
  from->require_option(1);
  auto* audience = app.add_option("--audience", request.audience, "The PNG to write");
  frames->needs(audience);
  desktop->needs(audience);
  audience->excludes(serves);
  app.add_option("--fault", request.faults,
                 "NAME.mirror=FAULT or NAME.control=FAULT: drop, garble, slow, silent, stuck, busy, cut")
      ->needs(serves);
  app.add_option("--faster", request.faster, "Mirrors turn so many times faster than real ones")
      ->check(CLI::Range(0.01, 1000.0))
      ->needs(serves);
  const auto checkSize = [](const std::string& text) {
    return sizeOf(text) ? std::string() : "expected WIDTHxHEIGHT, 16 to " + std::to_string(kLargestPicture) + " each";
  };
  app.add_option("--size", request.size, "Extent of the picture in pixels (default: 2400 wide)")
      ->check(CLI::Validator(checkSize, "WxH"));
  app.add_option("--margin", request.margin, "Wall shown around the display rectangle, per cent of its larger side")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
}

int run(const Request& request) {
  if (request.serves) {
    pixelflex::calib::serveDevices({request.wall, request.faults, request.faster},
                                   [](const std::string& line) { std::cout << line << std::endl; });
  } else {
    simulate(request);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Composes projector frames into what the audience of a simulated wall sees, or serves its devices, simulated.",
      "pixelflex simulate");
  Request request;
  defineOptions(app, request);
  return pixelflex::calib::runCommand(
      app, [&] { app.parse(argc, argv); }, [&] { return run(request); });
}
