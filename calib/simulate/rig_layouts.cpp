#include <array>
#include <utility>

#include "calib/simulate/rig_generator.h"
#include "calib/simulate/rig_parts.h"

namespace pixelflex::calib {

namespace {

constexpr std::array kTwoByTwo{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)};

}  // namespace

Rig stackedRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1024, 768};
  const double step = (1 - kFrameOverlap) * kFrameWidth;
  for (int layer = 0; layer < 2; ++layer) {
    for (const glm::dvec2 cell : kTwoByTwo) {
      const glm::dvec2 target = step * cell * glm::dvec2(1, 0.75);
      addPlaced(rig, drawProjector(random, kResolution, ""), {target}, 0.5, random);
    }
  }
  return finished(std::move(rig), random);
}

Rig portraitRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1024, 768};
  const double step = (1 - kFrameOverlap) * 0.75 * kFrameWidth;
  for (int i = 0; i < 3; ++i) {
    // Some people turn a projector to the left, some to the right.
    addPlaced(rig, drawProjector(random, kResolution, ""), {{step * i, 0}, kFrameWidth, i == 1 ? -90.0 : 90.0}, 0.5,
              random);
  }
  return finished(std::move(rig), random);
}

Rig shortThrowRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1280, 800};
  const double step = (1 - kFrameOverlap) * kFrameWidth;
  for (const glm::dvec2 cell : kTwoByTwo) {
    auto spec = drawProjector(random, kResolution, "");
    spec.optics.focal = decimals(kResolution.width * random.between(0.78, 0.85), 1);
    // Shifted by half a frame: from a table upwards, from the ceiling downwards.
    spec.optics.principal.y = cell.y * kResolution.height;
    spec.optics.radial = {decimals(random.between(-0.15, -0.1), 4), decimals(random.between(0.03, 0.05), 4), 0};
    const glm::dvec2 target = step * cell * glm::dvec2(1, 0.625);
    addPlaced(rig, std::move(spec), {target}, 0.4, random);
  }
  return finished(std::move(rig), random);
}

Rig insetRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  constexpr devices::Size kResolution{1024, 768};
  addPlaced(rig, drawProjector(random, kResolution, ""), {}, 1, random);
  const glm::dvec2 target{random.between(-250, 250), random.between(-150, 150)};
  addPlaced(rig, drawProjector(random, kResolution, ""), {target, kFrameWidth / 3}, 1, random);
  return finished(std::move(rig), random);
}

Rig islandsRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  const double step = (1 - kFrameOverlap) * kFrameWidth;
  const double across = kFrameWidth + step + 350;  // from one pair to the other
  for (const glm::dvec2 target :
       {glm::dvec2(0, 0), glm::dvec2(step, 0), glm::dvec2(across, 150), glm::dvec2(across + step, 150)}) {
    addPlaced(rig, drawProjector(random, {1024, 768}, ""), {target}, 0.5, random);
  }
  return finished(std::move(rig), random);
}

Rig lShapedRig(std::uint32_t seed) {
  Random random(seed);
  Rig rig{.seed = seed};
  const double step = (1 - kFrameOverlap) * kFrameWidth;
  for (const glm::dvec2 cell : {kTwoByTwo[0], kTwoByTwo[2], kTwoByTwo[3]}) {
    addPlaced(rig, drawProjector(random, {1024, 768}, ""), {step * cell * glm::dvec2(1, 0.75)}, 0.5, random);
  }
  return finished(std::move(rig), random);
}

}  // namespace pixelflex::calib
