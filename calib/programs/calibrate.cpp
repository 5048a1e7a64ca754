// pixelflex calibrate WALL [STEP…]: measures the wall with a camera, or from photographs.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/geometry/nudge_map.h"
#include "calib/patterns/colour_fields.h"
#include "calib/patterns/response_pattern.h"
#include "calib/procedure/drift_check.h"
#include "calib/procedure/procedure.h"
#include "calib/procedure/summary.h"
#include "calib/programs/calibrate_table.h"
#include "calib/programs/command_line.h"
#include "calib/programs/console_progress.h"
#include "calib/programs/nudge_argument.h"
#include "calib/programs/photograph_source.h"
#include "calib/report/report.h"
#include "calib/store/store.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string wall;
  std::vector<std::string> steps;
  std::string patterns;
  std::vector<std::string> photos;
  std::string method;
  std::vector<std::string> skip;
  std::vector<std::string> only;
  std::vector<std::string> nudges;
  std::vector<std::string> clearNudges;
  bool check = false;
  std::optional<double> recalibrate;  // pixels
  bool all = false;
  bool progress = false;
};

std::optional<Method> methodOf(const Arguments& arguments) {
  if (arguments.method.empty()) return std::nullopt;
  return arguments.method == methodName(Method::kDense) ? Method::kDense : Method::kBlobs;
}

void writePatternFolder(const Wall& wall, const Arguments& arguments) {
  const Method method = methodOf(arguments).value_or(Method::kBlobs);
  std::vector<ProjectorPatterns> projectors;
  std::size_t patterns = 0;
  for (const auto& config : wall.projectors) {
    const devices::Size size = config.resolution;
    auto& projector = projectors.emplace_back(config.name, size, patternsOf(method, size));
    if (wall.blend.matchesLight()) std::ranges::move(colourFields(size), std::back_inserter(projector.patterns));
    if (config.gammaByCamera) std::ranges::move(responsePatterns(size), std::back_inserter(projector.patterns));
    patterns += projector.patterns.size();
  }
  writePatterns(arguments.patterns, projectors, method);
  fmt::print("{} patterns for {} projectors in {}; read {}\n", patterns, projectors.size(), arguments.patterns,
             (fs::path(arguments.patterns) / "README.txt").string());
}

void requireProjectors(const Wall& wall, const std::string& option, const std::vector<std::string>& names) {
  for (const auto& name : names) {
    if (std::ranges::find(wall.projectors, name, &ProjectorConfig::name) == wall.projectors.end()) {
      throw ProcedureError(option + " " + name + ": no projector of this name in wall.yaml");
    }
  }
}

/// Measured steps can be left alone when their photographs are out of reach but only later ones were asked for.
bool needsPhotographs(const Wall& wall, const Arguments& arguments) {
  const bool photographsLight =
      wall.blend.matchesLight() || std::ranges::any_of(wall.projectors, &ProjectorConfig::gammaByCamera);
  const auto measured = [&](const std::string& step) {
    return step == "camera" || step == "surface" || step == "projectors" || (step == "gamma" && photographsLight);
  };
  return arguments.steps.empty() || std::ranges::any_of(arguments.steps, measured);
}

void finish(const fs::path& folder, const Wall& wall, const Calibration& calibration) {
  const Summary summary = summarise(wall, calibration);
  const fs::path report = folder / "report.html";
  devices::writeFileAtomically(report, reportHtml(folder, wall, calibration, summary));
  fmt::print("\n{}\nreport: {}\n", formatTable(wall, calibration, summary), report.string());
}

void calibrateFlat(const fs::path& folder, const Wall& wall) {
  const Calibration calibration = flatCalibration(wall);
  saveCalibration(folder, calibration);
  fmt::print("a flat wall needs no camera: computed from wall.yaml\n");
  finish(folder, wall, calibration);
}

/// Photographs of now are compared, and only compared.
std::vector<ProjectorDrift> check(const fs::path& folder, const Wall& wall, const Arguments& arguments) {
  const auto source = openSource(folder, wall, arguments.photos, false);
  ConsoleProgress progress(arguments.progress);
  auto drifts = checkDrift(loadCalibration(folder), source->photographs(), arguments.only, progress);
  fmt::print("\n{}", formatDrifts(drifts));
  return drifts;
}

/// Those whose picture has moved by more than `limit` pixels. Throws about those that cannot be seen at all.
std::vector<std::string> movedBeyond(const std::vector<ProjectorDrift>& drifts, double limit) {
  std::vector<std::string> moved;
  for (const auto& [name, drift, verdict] : drifts) {
    if (isUnseen(drift)) throw ProcedureError("projector " + name + ": " + verdict + "; nothing was measured again");
    if (isFarOff(drift) || drift.rms > limit) moved.push_back(name);
  }
  return moved;
}

void changeNudges(const fs::path& folder, const Wall& wall, const Arguments& arguments) {
  if (arguments.nudges.empty() && arguments.clearNudges.empty()) return;
  Nudges nudges = loadNudges(folder);
  requireProjectors(wall, "--clear-nudge", arguments.clearNudges);
  for (const auto& name : arguments.clearNudges) nudges.erase(name);
  for (const auto& text : arguments.nudges) {
    const auto [name, nudge] = parseNudgeArgument(text);
    requireProjectors(wall, "--nudge", {name});
    const auto config = std::ranges::find(wall.projectors, name, &ProjectorConfig::name);
    (void)nudgedFromMeasured(nudge, config->resolution);  // refuses corners that fold the frame
    nudges[name] = nudge;
  }
  saveNudges(folder, nudges);
}

/// What was measured before; with --all a damaged file does not matter.
Calibration earlierCalibration(const fs::path& folder, bool all) try {
  return hasCalibration(folder) ? loadCalibration(folder) : Calibration{};
} catch (const StoreError& error) {
  if (all) return {};
  throw std::runtime_error(std::string(error.what()) + "; pixelflex calibrate " + folder.string() +
                           " --all measures the wall anew");
}

void runProcedure(const fs::path& folder, const Wall& wall, const Arguments& arguments) {
  std::unique_ptr<PhotographSource> source;
  if (needsPhotographs(wall, arguments)) source = openSource(folder, wall, arguments.photos, true);
  ConsoleProgress progress(arguments.progress);
  Procedure procedure(folder, wall, earlierCalibration(folder, arguments.all),
                      source ? &source->photographs() : nullptr, progress);
  const auto ran = procedure.run({.steps = arguments.steps,
                                  .force = arguments.all,
                                  .skip = {arguments.skip.begin(), arguments.skip.end()},
                                  .only = {arguments.only.begin(), arguments.only.end()},
                                  .method = methodOf(arguments),
                                  .goOnWithoutFailed = source && source->isLive()});
  if (ran.empty()) fmt::print("nothing has changed since the last calibration (--all measures again)\n");
  if (!ran.empty()) procedure.save();
  finish(folder, wall, procedure.calibration());
}

/// What has moved is measured again, where it has moved by more than was asked.
void recalibrate(const fs::path& folder, const Wall& wall, Arguments arguments) {
  arguments.only = movedBeyond(check(folder, wall, arguments), arguments.recalibrate.value_or(0));
  if (arguments.only.empty()) {
    fmt::print("nothing has moved by more than {} px: nothing was measured again\n", *arguments.recalibrate);
  } else {
    std::string names;
    for (const auto& name : arguments.only) names += (names.empty() ? "" : ", ") + name;
    fmt::print("measured again: {}\n", names);
    runProcedure(folder, wall, arguments);
  }
}

void calibrate(const Arguments& arguments) {
  const fs::path folder = arguments.wall;
  const Wall wall = loadWall(folder);
  if (!arguments.patterns.empty()) return writePatternFolder(wall, arguments);
  if (wall.isFlat()) return calibrateFlat(folder, wall);
  requireProjectors(wall, "--skip", arguments.skip);
  const std::set<std::string> skipped(arguments.skip.begin(), arguments.skip.end());
  if (skipped.size() == wall.projectors.size()) throw std::runtime_error("--skip: no projector is left to calibrate");
  requireProjectors(wall, "--only", arguments.only);
  if (arguments.recalibrate) return recalibrate(folder, wall, arguments);
  if (arguments.check) return (void)check(folder, wall, arguments);
  changeNudges(folder, wall, arguments);
  runProcedure(folder, wall, arguments);
}

void defineOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("WALL", arguments.wall, "the wall's folder")->required();
  app.add_option("STEP", arguments.steps, "only these: camera surface projectors mesh blend gamma")
      ->check(CLI::IsMember(stepNames()));
  auto* patterns =
      app.add_option("--patterns", arguments.patterns, "only write what each projector must show into this folder");
  app.add_option("--photos", arguments.photos,
                 "work from the photographs in this folder; give it once for each place that the camera stood at")
      ->allow_extra_args(false)
      ->excludes(patterns);
  app.add_option(
         "--method", arguments.method,
         "what the projectors show: blobs (the default) or dense, stripes for curved screens and coarse cameras")
      ->check(CLI::IsMember({"blobs", "dense"}));
  app.add_option("--skip", arguments.skip, "leave these projectors out")->delimiter(',');
  app.add_option("--only", arguments.only, "measure these projectors again, against the stored rest")->delimiter(',');
  app.add_flag("--check", arguments.check, "photograph one pattern per projector and say how far each has moved");
  app.add_option("--recalibrate", arguments.recalibrate,
                 "check, then measure those again that have moved by more than so many of their pixels")
      ->check(CLI::Range(0.0, 1e4));
  app.add_option(
      "--nudge", arguments.nudges,
      "correct by hand, in projector pixels and degrees: NAME:x=1.5,y=-0.5,roll=0.1,tl=X/Y,tr=X/Y,br=X/Y,bl=X/Y; "
      "stays through calibrations");
  app.add_option("--clear-nudge", arguments.clearNudges, "take the correction by hand away again")->delimiter(',');
  app.add_flag("--all", arguments.all, "every step, stale or not");
  app.add_flag("--progress", arguments.progress, "tell how far it is in lines, for programs: progress STEP DONE TOTAL");
}

}  // namespace
}  // namespace pixelflex::calib

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app(
      "Measures the wall: camera, surface, projectors, mesh, blend, gamma. Without STEP: every step that is stale.",
      "pixelflex calibrate");
  calib::Arguments arguments;
  calib::defineOptions(app, arguments);
  return calib::runCommand(
      app, [&] { app.parse(argc, argv); },
      [&] {
        calib::calibrate(arguments);
        return 0;
      });
}
