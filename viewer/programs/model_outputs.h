#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "devices/display/event_loop.h"
#include "devices/display/gamma_keeper.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/programs/model_options.h"

namespace pixelflex::viewer {

/// What wall.yaml says of a calibrated projector. Throws PlanError when it is not there any more.
[[nodiscard]] const calib::Output& outputOf(const WallPlan& wall, const std::string& projector);

/// All windows of a process are on one display: the one that its outputs name, else $DISPLAY. Throws PlanError when
/// they name several.
[[nodiscard]] std::optional<std::string> displayOf(const WallPlan& wall);

/// The projectors that shine in a window of the room, numbers as of WallPlan::projectors(): those that are simulated,
/// or all where the command asks for the room.
[[nodiscard]] std::vector<std::size_t> roomOf(const ModelCommand& command, const WallPlan& wall);

/// A projector's window.
struct ProjectorScreen {
  std::size_t projector = 0;  // number as of WallPlan::projectors()
  glm::ivec2 at{0, 0};        // on the display, pixels
};

/// Of the projectors that have an output. Throws PlanError, DisplayError.
[[nodiscard]] std::vector<ProjectorScreen> screensOf(const WallPlan& wall, const devices::EventLoop& loop);

/// The keeper of the outputs' tables, where the command may need one. Before any thread.
[[nodiscard]] std::optional<devices::GammaKeeper> keeperFor(const ModelCommand& command, const WallPlan& wall);

/// Names of the projectors whose outputs look up codes: that have a response and an output with a table. `keeper`: none
/// when there is none. Throws PlanError where the command insists on it.
[[nodiscard]] std::vector<std::string> lookedUpInHardware(const ModelCommand& command, const WallPlan& wall,
                                                          const std::vector<ProjectorScreen>& screens,
                                                          devices::GammaKeeper* keeper);

/// Sets the tables of these projectors' outputs. Throws DisplayError.
void setTables(const WallPlan& wall, const std::vector<ProjectorScreen>& screens, const std::vector<std::string>& names,
               devices::GammaKeeper* keeper);

}  // namespace pixelflex::viewer
