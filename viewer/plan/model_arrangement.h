#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/model/model_renderer.h"
#include "viewer/plan/close_up.h"
#include "viewer/plan/one_pass_fit.h"
#include "viewer/plan/wall_plan.h"

namespace pixelflex::viewer {

struct ModelWallOptions {
  int passes = 1;                       // 2: drawn once for the desktop, which then goes the desktop's own way, and
                                        // once more for each projector that is much denser
  Features features = Features::kAll;   // of one pass
  bool lensAtVertices = false;          // one pass, for finely tessellated models
  bool desktop = false;                 // one pass: the desktop is drawn as well, to look at
  bool bothEyes = false;                // of the desktop, where no projector asks for them
  std::vector<std::string> inHardware;  // one pass: projectors whose outputs look codes up; their frames are sRGB
  ModelOptions model;
};

/// How a model comes onto all projectors of a wall: everything that does not need any graphics.
struct ModelArrangement {
  /// The second pass for one eye's picture of the desktop, or for a dense projector's close-up.
  struct Warp {
    std::size_t picture = 0;  // of outputs
    std::vector<OutputPlan> plans;
  };
  /// Of a projector: of one pass which output, of two which warp and which plan of it.
  struct Place {
    std::size_t warp = 0;
    std::size_t output = 0;
  };
  std::vector<OnePassFit> fits;
  std::vector<ModelOutput> outputs;  // projectors or close-ups, then the desktop's pictures
  std::size_t firstDesktop = 0;
  std::vector<Warp> warps;    // of two passes
  std::vector<Place> places;  // numbers as of WallPlan::projectors()
};

/// Throws PlanError.
[[nodiscard]] ModelArrangement arrangeModel(const WallPlan& wall, const ModelWallOptions& options);

}  // namespace pixelflex::viewer
