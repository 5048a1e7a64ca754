#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viewer/plan/wall_plan.h"
#include "viewer/programs/view_options.h"

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
/// desktop: `view` is called there. One that fails is said and the others go on; when a person ends one of them, all
/// end. Returns the exit status. Call it before there are other threads. Throws ViewError, and PasswordNeeded when a
/// process needs one.
int runViewers(const ViewOptions& options, const std::vector<DisplayShare>& shares,
               const std::function<int(const ViewOptions&)>& view);

}  // namespace pixelflex::viewer
