#pragma once

#include "viewer/renderer/output_plan.h"

namespace pixelflex::viewer {

/// Whether every pixel of the mesh lies on one desktop pixel, centre on centre to 1/100 px, upright, turned by quarters
/// or mirrored: then no filter is needed, and any would only blur. False for an empty mesh; its indices must be in
/// order.
[[nodiscard]] bool showsPixelsOneToOne(const WarpMesh& mesh);

}  // namespace pixelflex::viewer
