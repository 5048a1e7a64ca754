#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/accuracy/light_figures.h"
#include "tests/accuracy/light_measurement.h"
#include "tests/accuracy/light_rigs.h"

namespace pixelflex::calib {
namespace {

struct Options {
  std::uint32_t seeds = 1;
  std::uint32_t first = 1;
  std::vector<std::string> rigs{"pair", "report-8", "inset"};
  std::uint32_t compared = 1;
  bool strict = false;
  bool verbose = false;
};

constexpr std::string_view kMeasures =
    "The wall is photographed again: what all projectors truly throw on it from frames that the real renderer drew, as "
    "linear light, straight on. The display is 60 degrees wide; eyes blur by 2 desktop pixels; 8 at its edge do not "
    "count.\n"
    "Step: of the profile at right angles to a projector's true frame edge, 4 to 28 desktop pixels to either side, "
    "averaged along one degree of the edge, what neither its level nor its slope explains; relative, the largest of "
    "all edges inside the display, at uniformity 1 and 0.5. All with even black.\n"
    "Banding: RMS error of grey in the overlaps against white and black there, its mean taken out.\n"
    "Text: what an X client drew in black on white, projectors in focus (0.3 pixels); structural similarity of sRGB "
    "codes.\n\n";

int run(const Options& options) {
  LightFigures figures;
  const Findings add = [&](Figure figure, Correction correction, double value, const std::string& where) {
    figures.add(figure, correction, value, where);
    if (options.verbose) fmt::print(stderr, "{}: {}\n", where, LightFigures::told(figure, correction, value));
  };
  const std::set<std::string> wanted(options.rigs.begin(), options.rigs.end());
  for (const auto& kind : lightRigs()) {
    if (!wanted.contains(kind.name)) continue;
    for (std::uint32_t seed = options.first; seed < options.first + options.seeds; ++seed) {
      fmt::print(stderr, "{} {}\n", kind.name, seed);
      measureLight(kind, seed, seed < options.first + options.compared, add);
    }
  }
  std::string kinds;
  for (const auto& rig : options.rigs) kinds += (kinds.empty() ? "" : ", ") + rig;
  fmt::print("Light of simulated walls, {} seeds from {} of: {}.\n", options.seeds, options.first, kinds);
  fmt::print("{}", kMeasures);
  fmt::print("{}", figures.table());
  return options.strict && !figures.met() ? 1 : 0;
}

}  // namespace
}  // namespace pixelflex::calib

int main(int argc, char** argv) {
  CLI::App app("Light of simulated walls, photographed again, beside no correction and the report's own method");
  pixelflex::calib::Options options;
  std::vector<std::string> names;
  for (const auto& rig : pixelflex::calib::lightRigs()) names.push_back(rig.name);
  app.add_option("--seeds", options.seeds, "How many of each kind of rig")->check(CLI::PositiveNumber);
  app.add_option("--first", options.first, "The first seed");
  app.add_option("--rigs", options.rigs, "Only these, by commas")->delimiter(',')->check(CLI::IsMember(names));
  app.add_option("--compare", options.compared, "So many of the seeds also uncorrected and by the report's method");
  app.add_flag("--verbose", options.verbose, "Every figure as it is measured, on stderr");
  app.add_flag("--strict", options.strict, "Fail when a target is missed");
  CLI11_PARSE(app, argc, argv);
  try {
    return pixelflex::calib::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "light_table: {}\n", error.what());
    return 1;
  }
}
