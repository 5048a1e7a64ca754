#include "calib/programs/new_wall.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "calib/store/store.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

/// Steps between projectors are gone, a slow fall towards the corners stays: what nobody sees costs no light.
constexpr double kUsualUniformity = 0.5;

constexpr int kMaxScreens = 64;
constexpr int kMaxExtent = 32768;
constexpr std::int64_t kMaxArea = std::int64_t{1} << 29;

std::optional<int> parseCount(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && value > 0 ? std::optional(value) : std::nullopt;
}

/// "AxB" with positive whole numbers.
std::optional<devices::Size> parsePair(std::string_view text) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto first = parseCount(text.substr(0, x));
  const auto second = parseCount(text.substr(x + 1));
  return first && second ? std::optional(devices::Size{*first, *second}) : std::nullopt;
}

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw std::invalid_argument("\"" + std::string(text) + "\": " + why);
}

void checkBounds(std::string_view text, const FlatGrid& grid) {
  const auto [width, height] = grid.screen;
  if (std::int64_t{grid.columns} * grid.rows > kMaxScreens) refuse(text, "a wall has at most 64 screens");
  if (std::min(width, height) < 16 || std::max(width, height) > 16384) {
    refuse(text, "a screen has 16 to 16384 pixels each way");
  }
  const std::int64_t wholeWidth = std::int64_t{grid.columns} * width;
  const std::int64_t wholeHeight = std::int64_t{grid.rows} * height;
  if (std::max(wholeWidth, wholeHeight) > kMaxExtent || wholeWidth * wholeHeight > kMaxArea) {
    refuse(text, "the desktop would be larger than 32768 pixels on a side or 2^29 pixels in all");
  }
}

std::string nameOf(std::size_t index) {
  return std::string("p").append(std::to_string(index + 1));
}

Wall wallOfGrid(const FlatGrid& grid) {
  Wall wall;
  wall.surface.units = "px";
  wall.camera.source = "none";
  wall.display.margin = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      ProjectorConfig screen;
      screen.name = nameOf(wall.projectors.size());
      screen.resolution = grid.screen;
      screen.flatAt = glm::ivec2(column * grid.screen.width, row * grid.screen.height);
      wall.projectors.push_back(std::move(screen));
    }
  }
  return wall;
}

/// Folders from the first that does not exist down to `folder`.
std::vector<std::filesystem::path> missingFolders(std::filesystem::path folder) {
  std::vector<std::filesystem::path> missing;
  for (; !folder.empty() && !std::filesystem::exists(folder); folder = folder.parent_path()) missing.push_back(folder);
  std::ranges::reverse(missing);
  return missing;
}

/// Remembers what was made and removes it unless told to keep it.
class Undo {
 public:
  Undo() = default;
  ~Undo() {
    std::error_code ignored;  // a folder that somebody else has put a file into stays
    for (auto path = made_.rbegin(); path != made_.rend(); ++path) std::filesystem::remove(*path, ignored);
  }
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;

  void makeFolder(const std::filesystem::path& folder) {
    for (const auto& missing : missingFolders(folder)) {
      if (std::filesystem::create_directory(missing)) made_.push_back(missing);
    }
  }
  void makeFile(const std::filesystem::path& path, const std::string& text) {
    makeFolder(path.parent_path());
    devices::writeFileAtomically(path, text);
    made_.push_back(path);
  }
  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;
};

}  // namespace

FlatGrid parseFlatGrid(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto counts = colon == std::string_view::npos ? devices::Size{1, 1} : parsePair(text.substr(0, colon));
  const auto screen = parsePair(colon == std::string_view::npos ? text : text.substr(colon + 1));
  if (!counts || !screen) refuse(text, "expected WxH or COLSxROWS:WxH, e.g. 1024x768 or 2x2:1920x1080");
  const FlatGrid grid{counts->width, counts->height, *screen};
  checkBounds(text, grid);
  return grid;
}

std::vector<NewFile> filesOfFlatWall(const FlatGrid& grid) {
  const Wall wall = wallOfGrid(grid);
  return {{"calibration.yaml", formatCalibration(flatCalibration(wall))}, {"wall.yaml", commentedWall(wall)}};
}

std::vector<NewFile> filesOfRig(const Rig& rig, const std::string& rigText) {
  const std::string rigFile = "rig.yaml";
  Wall wall = wallOfRig(rig, rigFile);
  wall.blend.uniformity = kUsualUniformity;
  wall.blend.evenBlack = true;
  std::vector<NewFile> files = {{rigFile, rigText}};
  for (std::size_t i = 0; i < rig.projectors.size(); ++i) {
    const auto& gamma = wall.projectors.at(i).gamma;
    const auto seed = rig.seed + static_cast<std::uint32_t>(i);
    if (gamma) files.push_back({*gamma, readingsOfProjector(rig.projectors[i], seed)});
  }
  files.push_back({"wall.yaml", commentedWall(wall)});
  return files;
}

std::vector<NewFile> filesOfMonitors(const std::vector<FoundMonitor>& monitors) {
  Wall wall;
  wall.blend.uniformity = kUsualUniformity;
  wall.blend.evenBlack = true;
  wall.camera.checkerboard = Checkerboard{};
  for (const auto& [id, corner] : {std::pair(0, glm::dvec2(0, 0)), std::pair(1, glm::dvec2(3000, 0)),
                                   std::pair(2, glm::dvec2(3000, 1500)), std::pair(3, glm::dvec2(0, 1500))}) {
    wall.surface.fiducials.push_back({.aruco = id, .pointInCamera = {}, .pointInWall = corner});
  }
  for (const auto& monitor : monitors) {
    ProjectorConfig projector;
    projector.name = nameOf(wall.projectors.size());
    projector.resolution = monitor.resolution;
    projector.output.kind = OutputKind::kMonitor;
    projector.output.monitor = monitor.name;
    wall.projectors.push_back(std::move(projector));
  }
  return {{"wall.yaml", commentedWall(wall)}};
}

void makeWallFolder(const std::filesystem::path& folder, const std::vector<NewFile>& files) {
  for (const auto* name : {"wall.yaml", "calibration.yaml"}) {
    if (std::filesystem::exists(folder / name)) {
      throw std::runtime_error((folder / name).string() + ": there is a wall already; choose another folder");
    }
  }
  for (const auto& file : files) {
    if (std::filesystem::exists(folder / file.path)) {
      throw std::runtime_error((folder / file.path).string() + ": is there already; choose another folder");
    }
  }
  Undo undo;
  for (const auto& file : files) undo.makeFile(folder / file.path, file.text);
  undo.keep();
}

}  // namespace pixelflex::calib
