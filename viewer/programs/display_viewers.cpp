#include "viewer/programs/display_viewers.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <utility>

#include "viewer/programs/projector_windows.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {
namespace {

std::string serverOf(const std::string& display) {
  const auto dot = display.find('.', std::min(display.rfind(':'), display.size()));
  return display.substr(0, dot);
}

/// Screen 0 is the one that is meant when none is named.
std::string plainName(const std::string& display) {
  return display.ends_with(".0") ? serverOf(display) : display;
}

std::string usualDisplay() {
  const char* const usual = std::getenv("DISPLAY");
  return plainName(usual == nullptr ? "" : usual);
}

/// What is there once for the wall, or once for an X server, is left to the first viewer there.
ViewOptions optionsFor(const DisplayShare& share, bool first, bool firstOfServer, ViewOptions options) {
  options.projectors = share.projectors;
  options.statsOf = share.display;
  if (!firstOfServer) options.clipboardLimit = 0;
  if (first) return options;
  options.control = false;
  options.resize = Resize::kNo;
  return options;
}

/// All viewers add to it.
void emptyStatsFile(const ViewOptions& options) {
  if (!options.statsJson || std::ofstream(*options.statsJson)) return;
  throw ViewError("cannot write to " + *options.statsJson + ": give --stats-json another file");
}

}  // namespace

std::vector<DisplayShare> sharesOfDisplays(const WallPlan& wall) {
  std::vector<DisplayShare> shares;
  std::set<std::string> named;
  for (const auto* projector : wall.projectors()) {
    const auto& output = configOf(wall, projector->name).output;
    if (output.kind == calib::OutputKind::kNone) continue;
    const bool byDisplay = output.kind == calib::OutputKind::kDisplay;
    const std::string display = byDisplay ? plainName(output.display) : usualDisplay();
    if (byDisplay) named.insert(display);
    auto share = std::ranges::find(shares, display, &DisplayShare::display);
    if (share == shares.end()) share = shares.insert(shares.end(), {display, {}});
    share->projectors.push_back(projector->name);
  }
  if (named.size() < 2) return {};
  std::stable_partition(shares.begin(), shares.end(),
                        [](const DisplayShare& share) { return share.display == usualDisplay(); });
  return shares;
}

int runViewers(const ViewOptions& options, const std::vector<DisplayShare>& shares, ViewerProcesses::View view) {
  emptyStatsFile(options);
  ViewerProcesses viewers(std::move(view));
  std::set<std::string> servers;
  for (const DisplayShare& share : shares) {
    const bool first = servers.empty();
    const bool firstOfServer = servers.insert(serverOf(share.display)).second;
    viewers.add(share.display, optionsFor(share, first, firstOfServer, options));
  }
  return viewers.run();
}

}  // namespace pixelflex::viewer
