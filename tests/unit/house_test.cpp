#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/process.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

const fs::path kRoot = PIXELFLEX_SOURCE_DIR;
using Strings = std::vector<std::string>;

Strings linesOf(const fs::path& file) {
  Strings lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// All files of the parts of the house, relative to the root.
Strings sources() {
  Strings files;
  for (const auto* part : {"viewer", "calib", "devices", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / part)) {
      const auto extension = entry.path().extension();
      if (extension == ".h" || extension == ".cpp") files.push_back(fs::relative(entry.path(), kRoot).string());
    }
  }
  return files;
}

struct Include {
  std::string from;
  std::string file;
  bool angle = false;
};

std::vector<Include> includesOf(const std::string& from) {
  static const std::regex kInclude(R"rx(\s*#\s*include\s*([<"])([^>"]+)[>"].*)rx");
  std::vector<Include> includes;
  for (const auto& line : linesOf(kRoot / from)) {
    if (std::smatch match; std::regex_match(line, match, kInclude)) {
      includes.push_back({from, match[2].str(), match[1].str() == "<"});
    }
  }
  return includes;
}

/// "a.cpp includes b.h" for every include that `isWrong`.
template <class IsWrong>
Strings wrongIncludes(IsWrong isWrong) {
  Strings wrong;
  for (const auto& source : sources()) {
    for (const auto& include : includesOf(source)) {
      if (isWrong(include)) wrong.push_back(source + " includes " + include.file);
    }
  }
  return wrong;
}

bool isUnder(const std::string& path, std::string_view folder) {
  return path.starts_with(std::string(folder) + "/");
}

bool isUnderAny(const std::string& path, const Strings& folders) {
  return std::ranges::any_of(folders, [&](const std::string& folder) { return isUnder(path, folder); });
}

/// The root of a family of library headers: "opencv2" of opencv2/core.hpp.
std::string family(const Include& include) {
  return include.file.substr(0, include.file.find('/'));
}

TEST(House, ThereAreSourcesToLookAt) {
  EXPECT_GE(sources().size(), 60U);
  EXPECT_GE(includesOf("tests/unit/house_test.cpp").size(), 8U);
}

TEST(House, OwnHeadersAreNamedFromTheRoot) {
  const std::set<std::string> generated = {"shader_sources.h"};
  EXPECT_THAT(wrongIncludes([&](const Include& include) {
                return !include.angle && !generated.contains(include.file) && !fs::exists(kRoot / include.file);
              }),
              IsEmpty());
}

TEST(House, TheArrowsPointFromTheViewerToCalibrationToDevices) {
  EXPECT_THAT(wrongIncludes([](const Include& include) {
                if (isUnder(include.from, "devices")) return isUnderAny(include.file, {"viewer", "calib", "tests"});
                if (isUnder(include.from, "calib")) return isUnderAny(include.file, {"viewer", "tests"});
                return isUnder(include.from, "viewer") && isUnder(include.file, "tests");
              }),
              IsEmpty());
}

TEST(House, TheRendererKnowsNeitherCalibrationNorTheNetwork) {
  EXPECT_THAT(wrongIncludes([](const Include& include) {
                if (isUnderAny(include.from, {"viewer/renderer", "viewer/model"})) {
                  return isUnderAny(include.file, {"calib", "viewer/vnc"});
                }
                return isUnder(include.from, "viewer/vnc") && isUnderAny(include.file, {"calib", "viewer/renderer"});
              }),
              IsEmpty());
}

TEST(House, RenderNodesCarryNoOpenCv) {
  const Strings without = {"viewer", "devices", "calib/photometric", "calib/geometry", "calib/store", "calib/simulate"};
  EXPECT_THAT(wrongIncludes([&](const Include& include) {
                return isUnderAny(include.from, without) && family(include) == "opencv2";
              }),
              IsEmpty());
}

TEST(House, ThirdPartyHeadersStayInSourceFiles) {
  const std::set<std::string> families = {"opencv2",   "CGAL",   "ceres",     "yaml-cpp", "CLI",     "fmt",   "spdlog",
                                          "GLFW",      "epoxy",  "EGL",       "GL",       "rfb",     "X11",   "xcb",
                                          "Eigen",     "assimp", "jpeglib.h", "png.h",    "zlib.h",  "gtest", "gmock",
                                          "benchmark", "boost",  "arv.h",     "gphoto2",  "nlohmann"};
  EXPECT_THAT(wrongIncludes([&](const Include& include) {
                return include.from.ends_with(".h") && !isUnder(include.from, "tests") &&
                       families.contains(family(include));
              }),
              IsEmpty());
}

// Which shows that the header needs nothing before it.
TEST(House, EverySourceIncludesItsOwnHeaderFirst) {
  for (const auto& source : sources()) {
    if (!source.ends_with(".cpp")) continue;
    const std::string header = fs::path(source).replace_extension(".h").string();
    if (!fs::exists(kRoot / header)) continue;
    const auto includes = includesOf(source);
    EXPECT_TRUE(!includes.empty() && includes.front().file == header) << source;
  }
}

TEST(House, HeadersAreGuarded) {
  for (const auto& source : sources()) {
    if (!source.ends_with(".h")) continue;
    const auto lines = linesOf(kRoot / source);
    EXPECT_TRUE(std::ranges::find(lines, "#pragma once") != lines.end()) << source;
  }
}

TEST(House, ThereIsNoRoomForOddsAndEnds) {
  for (const auto* part : {"viewer", "calib", "devices", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / part)) {
      const std::string name = entry.path().filename().string();
      for (const auto* bad : {"common", "utils", "util", "misc", "helpers"}) EXPECT_NE(name, bad) << entry.path();
      // The parts of the product explain themselves in one place each; how to run a benchmark stands beside it.
      const bool ofTests = std::string_view(part) == "tests";
      EXPECT_FALSE(!ofTests && name == "README.md" && entry.path().parent_path().parent_path() != kRoot)
          << entry.path();
    }
  }
}

TEST(House, TheRootHoldsOnlyWhatBelongsThere) {
  const std::set<std::string> allowed = {"CHANGELOG.md",
                                         "CMakeLists.txt",
                                         "CMakePresets.json",
                                         "CONTRIBUTING.md",
                                         "LICENSE",
                                         "README.md",
                                         "calib",
                                         "config",
                                         "demo",
                                         "demo-out",
                                         "devices",
                                         "docs",
                                         "build",
                                         "packages.txt",
                                         "shaders",
                                         "test",
                                         "tests",
                                         "viewer"};
  for (const auto& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.starts_with('.') || allowed.contains(name)) << name;
  }
}

TEST(House, FileNamesAreInSnakeCase) {
  static const std::regex kSnake("[a-z0-9_]+\\.(h|cpp)");
  for (const auto& source : sources())
    EXPECT_TRUE(std::regex_match(fs::path(source).filename().string(), kSnake)) << source;
}

TEST(House, PackagesAreSortedAndNamedOnce) {
  Strings packages;
  for (const auto& line : linesOf(kRoot / "packages.txt")) {
    if (!line.empty() && line[0] != '#') packages.push_back(line);
  }
  EXPECT_GE(packages.size(), 30U);
  EXPECT_TRUE(std::ranges::is_sorted(packages));
  EXPECT_TRUE(std::ranges::adjacent_find(packages) == packages.end());
  static const std::regex kPackage("[a-z0-9][a-z0-9.+-]+");
  for (const auto& package : packages) EXPECT_TRUE(std::regex_match(package, kPackage)) << package;
}

TEST(House, SourcesAreFormatted) {
  std::vector<std::string> command = {"clang-format", "--dry-run", "-Werror"};
  for (const auto& source : sources()) command.push_back((kRoot / source).string());
  const Output output = run(command, {}, std::chrono::seconds(200));  // a thousand files, on a busy machine
  EXPECT_EQ(output.status, 0) << output.text.substr(0, 4000);
}

}  // namespace
}  // namespace pixelflex::testing
