#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/calibration.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// Something wrong in a file of the store. Lines and columns count from 1; 0 means the whole file.
struct Problem {
  std::string file;
  int line = 0;
  int column = 0;
  std::string message;
  /// "file:line:column: message", without the parts that are 0.
  [[nodiscard]] std::string text() const;
  bool operator==(const Problem&) const = default;
};

/// A file of the store cannot be used. Carries every problem found; what() joins them, one a line.
class StoreError : public std::runtime_error {
 public:
  explicit StoreError(std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

inline constexpr int kWallVersion = 1;
inline constexpr int kCalibrationVersion = 1;

/// Parses, migrates from older versions and validates. All problems at once. `file` is only used in messages. Never
/// crashes, whatever the text. Throws StoreError.
[[nodiscard]] Wall parseWall(std::string_view text, const std::string& file);
[[nodiscard]] Calibration parseCalibration(std::string_view text, const std::string& file);

/// Text that parses back to an equal value.
[[nodiscard]] std::string formatWall(const Wall& wall);
[[nodiscard]] std::string formatCalibration(const Calibration& calibration);

/// `folder` is the wall's folder. Files: folder/wall.yaml and folder/calibration.yaml. Throw StoreError (a missing
/// calibration.yaml says to run `pixelflex calibrate WALL`).
[[nodiscard]] Wall loadWall(const std::filesystem::path& folder);
[[nodiscard]] Calibration loadCalibration(const std::filesystem::path& folder);
[[nodiscard]] bool hasCalibration(const std::filesystem::path& folder);

/// Atomic: a killed program leaves the old file or the new one.
void saveWall(const std::filesystem::path& folder, const Wall& wall);
void saveCalibration(const std::filesystem::path& folder, const Calibration& calibration);

/// Everything wrong with every file of the wall: wall.yaml, calibration.yaml where there is one, the files that they
/// name (readings, masks) and whether the two belong together. Empty means all is well.
[[nodiscard]] std::vector<Problem> checkWall(const std::filesystem::path& folder);

/// A calibration of a flat wall, exact by construction: display in desktop pixels, one sample per corner.
[[nodiscard]] Calibration flatCalibration(const Wall& wall);

}  // namespace pixelflex::calib
