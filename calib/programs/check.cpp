// pixelflex check WALL: lists everything wrong with the files of a wall.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "calib/photometric/response_curve.h"
#include "calib/programs/command_line.h"
#include "calib/simulate/rig.h"
#include "calib/store/readings_file.h"
#include "calib/store/store.h"
#include "calib/store/yaml_reader.h"

namespace {

using pixelflex::calib::Problem;

/// Readings that can be read may still be none of a projector: falling, clipped, below the meter's threshold.
void checkResponses(const std::filesystem::path& folder, const pixelflex::calib::Wall& wall,
                    std::vector<Problem>& problems) {
  for (const auto& projector : wall.projectors) {
    if (!projector.gamma || !std::filesystem::is_regular_file(folder / *projector.gamma)) continue;
    const std::string file = (folder / *projector.gamma).string();
    if (!pixelflex::calib::checkReadings(file).empty()) continue;  // listed already
    try {
      (void)pixelflex::calib::parseReadings(pixelflex::calib::readStoreFile(file), file);
    } catch (const pixelflex::calib::ResponseError& error) {
      problems.push_back({"", 0, 0, error.what()});  // names its file
    }
  }
}

/// The problems of the files that the store knows, of readings and of the simulated rig, if there is one.
std::vector<Problem> problemsOf(const std::filesystem::path& folder) {
  auto problems = pixelflex::calib::checkWall(folder);
  try {
    const auto wall = pixelflex::calib::loadWall(folder);
    checkResponses(folder, wall, problems);
    if (wall.rig && std::filesystem::exists(folder / *wall.rig)) (void)pixelflex::calib::loadRig(folder / *wall.rig);
  } catch (const pixelflex::calib::StoreError& error) {
    // wall.yaml's own problems are listed already.
    for (const auto& problem : error.problems()) {
      if (problem.file != (folder / "wall.yaml").string()) problems.push_back(problem);
    }
  }
  return problems;
}

std::string summaryOf(const std::filesystem::path& folder) {
  const auto wall = pixelflex::calib::loadWall(folder);
  const std::size_t count = wall.projectors.size();
  std::string text = std::to_string(count) + (count == 1 ? " projector" : " projectors");
  if (!pixelflex::calib::hasCalibration(folder)) {
    return text + "; not calibrated yet: pixelflex calibrate " + folder.string();
  }
  const auto calibration = pixelflex::calib::loadCalibration(folder);
  text += ", " + std::to_string(calibration.projectors.size()) + " calibrated";
  if (const auto& display = calibration.display) {
    text += ", a desktop of " + std::to_string(display->resolution.width) + "x" +
            std::to_string(display->resolution.height) + " pixels";
  }
  return text;
}

int check(const std::string& folder) {
  const auto problems = problemsOf(folder);
  for (const auto& problem : problems) std::cout << problem.text() << '\n';
  if (problems.empty()) {
    std::cout << folder << ": no problems\n" << summaryOf(folder) << '\n';
    return 0;
  }
  std::cout.flush();
  std::cerr << "pixelflex-check: " << folder << ": " << problems.size()
            << (problems.size() == 1 ? " problem\n" : " problems\n");
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Lists everything wrong with the files of a wall, each with file and line.", "pixelflex check");
  std::string folder;
  app.add_option("WALL", folder, "The wall's folder")->required();
  return pixelflex::calib::runCommand(
      app, [&] { app.parse(argc, argv); }, [&] { return check(folder); });
}
