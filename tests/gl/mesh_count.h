#pragma once

#include <span>

#include "devices/image/image.h"
#include "viewer/renderer/output_plan.h"

namespace pixelflex::testing {

/// How many triangles of a warp mesh cover each pixel's centre: every triangle of every patch drawn once, adding one,
/// by the same vertex arithmetic as the renderer's and with nothing that could hide one triangle behind another. Needs
/// a current context.
[[nodiscard]] devices::Image<int> countTriangles(const viewer::WarpMesh& mesh, devices::Size resolution);

}  // namespace pixelflex::testing
