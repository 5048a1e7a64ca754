#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "devices/image/image.h"
#include "devices/image/png_file.h"

namespace pixelflex::testing {

/// Where pictures of a failed comparison go: in the build tree, a folder per comparison.
inline std::filesystem::path failureFolder(const std::string& name) {
  return std::filesystem::path(PIXELFLEX_BIN_DIR) / ".." / "image-failures" / name;
}

/// Per sample |actual - expected|, stretched so that the smallest difference can be seen.
inline devices::Image8 differenceOf(const devices::Image8& actual, const devices::Image8& expected) {
  devices::Image8 difference(actual.size(), actual.channels());
  for (std::size_t i = 0; i < difference.samples().size(); ++i) {
    const int apart = std::abs(int{actual.samples()[i]} - int{expected.samples()[i]});
    difference.samples()[i] = static_cast<std::uint8_t>(apart == 0 ? 0 : std::min(255, 55 + 20 * apart));
  }
  return difference;
}

inline void writeFailure(const devices::Image8& actual, const devices::Image8& expected, const std::string& name) {
  const auto folder = failureFolder(name);
  std::filesystem::create_directories(folder);
  if (!actual.empty()) devices::writePng(folder / "actual.png", actual);
  if (!expected.empty()) devices::writePng(folder / "expected.png", expected);
  if (actual.size() == expected.size() && actual.channels() == expected.channels() && !actual.empty()) {
    devices::writePng(folder / "diff.png", differenceOf(actual, expected));
  }
}

/// True when the images have one size and no sample differs by more than `tolerance` codes. Otherwise says how many do
/// and where the worst is, and leaves actual.png, expected.png and diff.png in failureFolder(name).
inline ::testing::AssertionResult imageNear(const devices::Image8& actual, const devices::Image8& expected,
                                            int tolerance, const std::string& name) {
  if (actual.size() != expected.size() || actual.channels() != expected.channels()) {
    writeFailure(actual, expected, name);
    return ::testing::AssertionFailure() << name << ": " << actual.width() << "x" << actual.height() << "x"
                                         << actual.channels() << " instead of " << expected.width() << "x"
                                         << expected.height() << "x" << expected.channels();
  }
  std::size_t different = 0;
  std::size_t worstAt = 0;
  int worst = 0;
  for (std::size_t i = 0; i < actual.samples().size(); ++i) {
    const int apart = std::abs(int{actual.samples()[i]} - int{expected.samples()[i]});
    if (apart > tolerance) ++different;
    if (apart > worst) {
      worst = apart;
      worstAt = i;
    }
  }
  if (different == 0) return ::testing::AssertionSuccess();
  writeFailure(actual, expected, name);
  const auto pixel = worstAt / static_cast<std::size_t>(actual.channels());
  const auto width = static_cast<std::size_t>(actual.width());
  return ::testing::AssertionFailure() << name << ": " << different << " samples differ by more than " << tolerance
                                       << ", the worst by " << worst << " at (" << pixel % width << ", "
                                       << pixel / width << "); see " << failureFolder(name);
}

}  // namespace pixelflex::testing
