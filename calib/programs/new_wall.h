#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calib/simulate/rig.h"
#include "calib/store/wall.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// A file of a wall that is about to be made; the path is relative to the wall's folder.
struct NewFile {
  std::filesystem::path path;
  std::string text;
};

/// "1024x768" or "2x2:1920x1080": a grid of equal screens.
struct FlatGrid {
  int columns = 1;
  int rows = 1;
  devices::Size screen;
  bool operator==(const FlatGrid&) const = default;
};

/// A monitor that a projector is plugged into.
struct FoundMonitor {
  std::string name;
  devices::Size resolution;
};

/// Throws std::invalid_argument saying what is wrong with the text.
[[nodiscard]] FlatGrid parseFlatGrid(std::string_view text);

/// wall.yaml and calibration.yaml of screens p1, p2, … row by row, that show the desktop one to one.
[[nodiscard]] std::vector<NewFile> filesOfFlatWall(const FlatGrid& grid);

/// wall.yaml, the rig itself (its text unchanged) and the readings of its projectors.
[[nodiscard]] std::vector<NewFile> filesOfRig(const Rig& rig, const std::string& rigText);

/// wall.yaml with one projector a monitor and the places of the markers for a person to correct.
[[nodiscard]] std::vector<NewFile> filesOfMonitors(const std::vector<FoundMonitor>& monitors);

/// Makes the folder and its files, wall.yaml last. Throws std::runtime_error when one of the files is there already or
/// cannot be written; what was made until then is removed again.
void makeWallFolder(const std::filesystem::path& folder, const std::vector<NewFile>& files);

/// formatWall with remarks for the person who will edit the file; parses to an equal wall.
[[nodiscard]] std::string commentedWall(const Wall& wall);

}  // namespace pixelflex::calib
