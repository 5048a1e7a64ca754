#pragma once

#include <string>
#include <vector>

#include "viewer/plan/wall_plan.h"
#include "viewer/programs/view_options.h"
#include "viewer/programs/viewer_processes.h"

namespace pixelflex::viewer {

/// An X display and the projectors whose windows are on it.
struct DisplayShare {
  std::string display;
  std::vector<std::string> projectors;
};

/// The displays of a wall that needs more than one, that of $DISPLAY first if it is among them; projectors that are
/// named by their monitor are on that. Empty: one process can show all.
[[nodiscard]] std::vector<DisplayShare> sharesOfDisplays(const WallPlan& wall);

/// Windows of one process are on one display, so each display gets a process of its own, with its own connection to the
/// desktop: `view` is called there. The control window, and the wish for another size of the desktop, are those of the
/// first; an X server's clipboard is that of the first there. See ViewerProcesses for what becomes of them, for what is
/// returned and thrown.
int runViewers(const ViewOptions& options, const std::vector<DisplayShare>& shares, ViewerProcesses::View view);

}  // namespace pixelflex::viewer
