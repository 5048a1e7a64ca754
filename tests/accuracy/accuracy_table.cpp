#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <vector>

#include "tests/accuracy/accuracy_rigs.h"
#include "tests/accuracy/report_pipeline.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "tests/support_calibration/coordinate_desktop.h"

namespace pixelflex::calib {
namespace {

/// One method on one rig, a number a seed.
struct Column {
  std::vector<double> values;
  [[nodiscard]] double worst() const { return *std::ranges::max_element(values); }
  [[nodiscard]] double median() const {
    auto sorted = values;
    std::ranges::sort(sorted);
    return sorted[sorted.size() / 2];
  }
  [[nodiscard]] std::string text() const { return fmt::format("{:.3f} / {:.3f}", median(), worst()); }
};

struct Row {
  Column seamRms, seamP95, seamMaximum, absoluteRms, absoluteMaximum;

  void add(const RegistrationFigures& figures) {
    seamRms.values.push_back(figures.seam.rms);
    seamP95.values.push_back(figures.seam.p95);
    seamMaximum.values.push_back(figures.seam.maximum);
    absoluteRms.values.push_back(figures.all.rms);
    absoluteMaximum.values.push_back(figures.all.maximum);
  }

  [[nodiscard]] std::string missed(const AccuracyTarget& target) const {
    std::string text;
    const auto check = [&](const Column& column, double limit, const char* name) {
      if (column.worst() > limit) text += std::string(text.empty() ? "" : ", ") + name;
    };
    check(seamRms, target.seamRms, "seam RMS");
    check(seamMaximum, target.seamMaximum, "seam max");
    check(absoluteRms, target.absoluteRms, "absolute RMS");
    return text;
  }
};

void print(const AccuracyRig& rig, const std::string& method, const Row& row) {
  const std::string missed = row.missed(rig.target);
  fmt::print("| {:15} | {:9} | {} | {} | {} | {} | {} | {:.2f} / {:.2f}, {:.1f} | {} |\n", rig.name, method,
             row.seamRms.text(), row.seamP95.text(), row.seamMaximum.text(), row.absoluteRms.text(),
             row.absoluteMaximum.text(), rig.target.seamRms, rig.target.seamMaximum, rig.target.absoluteRms,
             missed.empty() ? "met" : "missed: " + missed);
  std::fflush(stdout);
}

struct Rows {
  Row ours, report;
};

/// Throws when not every projector can be calibrated. Warnings (a checkerboard photograph left out) are told.
void addSeed(const AccuracyRig& kind, std::uint32_t seed, Rows& rows) {
  SimulatedWall room(kind.make(seed));
  const testing::TemporaryFolder folder;
  const auto calibrated = calibrateRig(room, folder.path(), kind.dense ? Method::kDense : Method::kBlobs);
  for (const auto& warning : calibrated.warnings) {
    fmt::print(stderr, "{}, seed {}: {}\n", kind.name, seed, warning);
  }
  if (calibrated.calibration.projectors.size() != room.projectorCount()) {
    throw std::runtime_error("not every projector could be calibrated");
  }
  const viewer::WallPlan wall(folder.path(), calibrated.wall, calibrated.calibration, {});
  const auto shown = showCoordinates(room.rig(), wall);
  rows.ours.add(measureRegistration(room, meantByPictures(calibrated.calibration.display.value(), shown), kind.unit));
  // The report photographs blobs, from one place.
  if (kind.dense || room.placeCount() > 1) return;
  rows.report.add(
      measureRegistration(room, meantByReportPipeline(folder / "captures", calibrated.calibration), kind.unit));
}

struct Options {
  std::uint32_t seeds = 1;
  std::uint32_t first = 1;
  std::vector<std::string> rigs;
  bool strict = false;
};

/// True when the rig was calibrated (and, with `strict`, met its target).
bool runRig(const AccuracyRig& kind, const Options& options) {
  Rows rows;
  for (std::uint32_t seed = options.first; seed < options.first + options.seeds; ++seed) {
    try {
      addSeed(kind, seed, rows);
    } catch (const std::exception& error) {
      fmt::print("| {:15} | seed {}: {} |\n", kind.name, seed, error.what());
      return false;
    }
  }
  print(kind, "PixelFlex", rows.ours);
  if (!rows.report.seamRms.values.empty()) print(kind, "report's", rows.report);
  return !options.strict || rows.ours.missed(kind.target).empty();
}

int run(const Options& options) {
  fmt::print("Errors in projector pixels against ground truth, median / worst of {} seeds from {}.\n", options.seeds,
             options.first);
  fmt::print("\"report's\": raw centroids and affine Delaunay triangles, within the hull of the blobs.\n\n");
  fmt::print("| rig | pipeline | seam RMS | seam p95 | seam max | absolute RMS | absolute max | target | worst |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  const std::set<std::string> wanted(options.rigs.begin(), options.rigs.end());
  bool good = true;
  for (const auto& kind : accuracyRigs()) {
    if (wanted.empty() || wanted.contains(kind.name)) good = runRig(kind, options) && good;
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace pixelflex::calib

int main(int argc, char** argv) {
  CLI::App app("Registration of simulated walls, through the real renderer, beside the report's own pipeline");
  pixelflex::calib::Options options;
  std::vector<std::string> names;
  for (const auto& rig : pixelflex::calib::accuracyRigs()) names.push_back(rig.name);
  app.add_option("--seeds", options.seeds, "How many of each kind of rig")->check(CLI::PositiveNumber);
  app.add_option("--first", options.first, "The first seed");
  app.add_option("--rigs", options.rigs, "Only these, by commas")->delimiter(',')->check(CLI::IsMember(names));
  app.add_flag("--strict", options.strict, "Fail when a target is missed, not only when a rig cannot be calibrated");
  CLI11_PARSE(app, argc, argv);
  try {
    return pixelflex::calib::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "accuracy_table: {}\n", error.what());
    return 1;
  }
}
