#pragma once

#include "viewer/plan/desktop_fit.h"
#include "viewer/renderer/output_plan.h"
#include "viewer/tiles/tile_layout.h"

namespace pixelflex::viewer {

/// The mesh of a flat screen, at `screenAt` on the wall's own desktop, that shows a scaled desktop: rectangles, cut
/// where tiles meet and at the screen's border.
[[nodiscard]] WarpMesh scaledScreen(const TileLayout& layout, const Placement& placement, glm::ivec2 screenAt,
                                    devices::Size screen);

}  // namespace pixelflex::viewer
