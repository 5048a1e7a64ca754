#pragma once

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/store/store.h"

namespace pixelflex::testing {

/// A saved file of tests/data.
inline std::string dataFile(const std::string& name) {
  std::ifstream file(std::string(PIXELFLEX_SOURCE_DIR) + "/tests/data/" + name, std::ios::binary);
  if (!file) throw std::runtime_error("no test data " + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What parsing throws, as "line:column message" each; empty when it does not.
template <class Parse>
std::vector<std::string> problemsOf(Parse parse) {
  std::vector<std::string> texts;
  try {
    (void)parse();
  } catch (const calib::StoreError& error) {
    for (const auto& problem : error.problems()) {
      texts.push_back(std::to_string(problem.line) + ":" + std::to_string(problem.column) + " " + problem.message);
    }
  }
  return texts;
}

inline std::vector<std::string> wallProblems(const std::string& text) {
  return problemsOf([&] { return calib::parseWall(text, "wall.yaml"); });
}

inline std::vector<std::string> calibrationProblems(const std::string& text) {
  return problemsOf([&] { return calib::parseCalibration(text, "calibration.yaml"); });
}

/// The wall of the commands-and-files contract, built by hand.
inline calib::Wall exampleWall() {
  calib::Wall wall;
  wall.surface.fiducials = {{.aruco = 0, .pointInCamera = {}, .pointInWall = {0, 0}},
                            {.aruco = 1, .pointInCamera = {}, .pointInWall = {3000, 0}},
                            {.aruco = 2, .pointInCamera = {}, .pointInWall = {3000, 1500}},
                            {.aruco = 3, .pointInCamera = {}, .pointInWall = {0, 1500}}};
  wall.camera = {.source = "photos", .checkerboard = calib::Checkerboard{9, 6, 30}};
  calib::ProjectorConfig p1;
  p1.name = "p1";
  p1.resolution = {1024, 768};
  p1.output.kind = calib::OutputKind::kMonitor;
  p1.output.monitor = "HDMI-1";
  p1.gamma = "readings/p1.csv";
  p1.control = calib::DeviceLine{"pjlink", "tcp://10.0.0.5:4352", {}};
  p1.mirror = calib::DeviceLine{"ptu", "tcp://10.0.0.9:2101", {}};
  wall.projectors = {p1};
  return wall;
}

/// A flat wall of `columns` x `rows` screens of 1024x768.
inline calib::Wall flatWall(int columns, int rows) {
  calib::Wall wall;
  wall.camera.source = "none";
  for (int i = 0; i < columns * rows; ++i) {
    calib::ProjectorConfig screen;
    screen.name = "s" + std::to_string(i + 1);
    screen.resolution = {1024, 768};
    screen.flatAt = glm::ivec2(i % columns * 1024, i / columns * 768);
    wall.projectors.push_back(screen);
  }
  return wall;
}

}  // namespace pixelflex::testing
