#pragma once

#include "viewer/plan/wall_plan.h"
#include "viewer/programs/model_options.h"

namespace pixelflex::viewer {

/// Draws without any window and writes the pictures that the command asks for. Returns the exit status.
int runModelHeadless(const ModelCommand& command, const WallPlan& wall, Scene scene);

/// Every projector's picture as folder/NAME.png, and the desktop's as folder/desktop.png.
/// `stereo`: instead of the desktop's own, where there is one.
void writeModelPictures(const std::filesystem::path& folder, ModelWall& model, StereoPicture* stereo);

/// How far one pass is from the calibrated lenses, and what to do where that is too far.
void printFits(const ModelCommand& command, const WallPlan& wall, const ModelWall& model);

}  // namespace pixelflex::viewer
