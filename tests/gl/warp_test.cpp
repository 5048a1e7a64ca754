// The warp against an independent renderer in double precision, over meshes, masks, sizes, filters and ways of damage.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "tests/support_image/image_near.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;
using testing::WeightedMap;

enum class Shape { kIdentity, kAffine, kHomography, kBent };
enum class Alpha { kNone, kRamp };
enum class Damage { kFull, kMoving, kOverlapping, kMany, kZero, kOutOfBounds };

WeightedMap mapOf(Shape shape, Size resolution, Size desktop) {
  switch (shape) {
    case Shape::kIdentity:
      return testing::identityMap({-7.25, 3.5});
    case Shape::kAffine:
      return testing::affineMap(resolution, desktop);
    case Shape::kHomography:
      return testing::homographyMap(resolution, desktop);
    case Shape::kBent:
      return testing::bentMap(resolution, desktop);
  }
  return {};
}

devices::Image16 rampMask(Size size) {
  devices::Image16 mask(size, 1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double ramp = std::min(1.0, 4.0 * x / size.width) * (0.25 + 0.75 * y / size.height);
      mask.at(x, y) = static_cast<std::uint16_t>(std::lround(65535 * ramp));
    }
  }
  return mask;
}

reference::InverseMap analytic(const WeightedMap& map, Size desktop) {
  return [=](glm::dvec2 p) -> std::optional<glm::dvec2> {
    const auto weighted = map(p);
    const glm::dvec2 at(weighted.x / weighted.z, weighted.y / weighted.z);
    if (at.x < 0 || at.y < 0 || at.x > desktop.width || at.y > desktop.height) return {};
    return at;
  };
}

/// One projector, told to the renderer and to the reference.
struct Case {
  OutputPlan plan;
  reference::Job job;
};

Case makeCase(Shape shape, Alpha alpha, Size resolution, Size desktop) {
  const auto map = mapOf(shape, resolution, desktop);
  const int columns = shape == Shape::kBent ? 8 : 2;
  const int rows = shape == Shape::kBent ? 6 : 1;
  Case made{testing::planOf("p", map, resolution, desktop, columns, rows), {}};
  made.job.resolution = resolution;
  made.job.desktopFromProjector =
      shape == Shape::kBent ? reference::mapOfTriangles(testing::gridOf(map, resolution, columns, rows), desktop)
                            : analytic(map, desktop);
  if (alpha == Alpha::kRamp) {
    made.plan.alpha = rampMask(resolution);
    made.job.alpha = [mask = made.plan.alpha](int x, int y) { return mask.at(x, y) / 65535.0; };
  }
  return made;
}

std::vector<OutputPlan> plansOf(const std::vector<Case>& cases) {
  std::vector<OutputPlan> plans;
  plans.reserve(cases.size());
  for (const auto& one : cases) plans.push_back(one.plan);
  return plans;
}

/// Whether the 3x3 pixels around are all inside or all outside the picture.
bool clearOfEdges(const devices::Image<double>& frame, int x, int y) {
  double sum = 0;
  int count = 0;
  for (int j = std::max(0, y - 1); j <= std::min(frame.height() - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(frame.width() - 1, x + 1); ++i) {
      sum += frame.at(i, j, 3);
      ++count;
    }
  }
  return sum == 0 || sum == count;
}

struct Difference {
  double worst = 0;
  int x = 0, y = 0;
  std::int64_t compared = 0;
};

Difference compare(const Image8& actual, const devices::Image<double>& expected) {
  Difference difference;
  for (int y = 0; y < actual.height(); ++y) {
    for (int x = 0; x < actual.width(); ++x) {
      if (!clearOfEdges(expected, x, y)) continue;
      ++difference.compared;
      for (int c = 0; c < 3; ++c) {
        const double apart = std::abs(actual.at(x, y, c) - expected.at(x, y, c));
        if (apart > difference.worst) difference = {apart, x, y, difference.compared};
      }
    }
  }
  return difference;
}

void expectLike(const Image8& actual, const devices::Image<double>& expected, const std::string& name) {
  const auto difference = compare(actual, expected);
  EXPECT_GT(difference.compared, actual.size().area() / 2);
  EXPECT_LE(difference.worst, 1.5) << "at (" << difference.x << ", " << difference.y << ")";
  if (difference.worst <= 1.5) return;
  Image8 rounded(actual.size(), 3);
  for (int y = 0; y < actual.height(); ++y) {
    for (int x = 0; x < actual.width(); ++x) {
      for (int c = 0; c < 3; ++c) rounded.at(x, y, c) = static_cast<std::uint8_t>(std::lround(expected.at(x, y, c)));
    }
  }
  testing::writeFailure(actual, rounded, name);
}

/// The boxes of one step of damage.
std::vector<Box> boxesOf(Damage damage, int step, Size desktop) {
  const int w = desktop.width;
  const int h = desktop.height;
  switch (damage) {
    case Damage::kFull:
      return {boxOf(desktop)};
    case Damage::kMoving:
      return {{w / 8 * step, h / 6 * step, w / 8 * step + w / 5, h / 6 * step + h / 4}};
    case Damage::kOverlapping:
      return {{w / 4, h / 4, w / 2 + 9, h / 2 + 9}, {w / 3, h / 3, w - 5, h - 3}, {w / 4, h / 4, w / 2, h / 2}};
    case Damage::kMany: {
      std::vector<Box> boxes;
      for (int i = 0; i < 100; ++i) {
        const int x = (i * 37 + step * 11) % (w - 9);
        const int y = (i * 53 + step * 17) % (h - 7);
        boxes.push_back({x, y, x + 1 + i % 9, y + 1 + i % 7});
      }
      return boxes;
    }
    case Damage::kZero:
      return {};
    case Damage::kOutOfBounds:
      return {{-40, -30, 60, 20}, {w - 20, h - 30, w + 50, h + 3}, {w + 5, 0, w + 40, 30}, {-9, 40, 0, 60}};
  }
  return {};
}

/// The desktop after the boxes have been given new content.
Image8 changed(const Image8& desktop, const std::vector<Box>& boxes, std::uint32_t seed) {
  auto result = desktop;
  const auto fresh = testing::testDesktop(desktop.size(), seed);
  for (const auto& box : boxes) {
    const auto inside = intersect(box, boxOf(desktop.size()));
    for (int y = inside.top; y < inside.bottom; ++y) {
      for (int x = inside.left; x < inside.right; ++x) {
        for (int c = 0; c < 3; ++c) result.at(x, y, c) = fresh.at(x, y, c);
      }
    }
  }
  return result;
}

using MatrixParameter = std::tuple<Shape, Alpha, Damage>;
class WarpMatrixTest : public testing::GlTest<::testing::TestWithParam<MatrixParameter>> {};

TEST_P(WarpMatrixTest, MatchesTheReferenceAndAFullRedraw) {
  const auto [shape, alpha, damage] = GetParam();
  const Size desktop{331, 257};
  const std::vector<Case> cases{makeCase(shape, alpha, {161, 121}, desktop),
                                makeCase(shape, alpha, {67, 203}, desktop)};
  const auto plans = plansOf(cases);
  WallRenderer incremental(context_);
  incremental.setPlans(plans);
  auto picture = testing::testDesktop(desktop);
  incremental.upload(testing::wholeBatch(picture));
  incremental.draw();
  for (int step = 0; step < 4; ++step) {
    const auto boxes = boxesOf(damage, step, desktop);
    picture = changed(picture, boxes, static_cast<std::uint32_t>(7 + step));
    incremental.upload(testing::batchOf(picture, boxes));
    incremental.draw();
  }
  WallRenderer fresh(context_);
  fresh.setPlans(plans);
  fresh.upload(testing::wholeBatch(picture));
  fresh.draw();
  EXPECT_EQ(incremental.readDesktop(), picture);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto name = "warp-" + std::to_string(static_cast<int>(shape)) + std::to_string(static_cast<int>(alpha)) +
                      std::to_string(static_cast<int>(damage)) + "-" + std::to_string(i);
    expectLike(incremental.readOutput(i), reference::warp(picture, cases[i].job), name);
    EXPECT_TRUE(testing::imageNear(incremental.readOutput(i), fresh.readOutput(i), 0, name + "-redraw"));
  }
}

INSTANTIATE_TEST_SUITE_P(All, WarpMatrixTest,
                         ::testing::Combine(::testing::Values(Shape::kIdentity, Shape::kAffine, Shape::kHomography,
                                                              Shape::kBent),
                                            ::testing::Values(Alpha::kNone, Alpha::kRamp),
                                            ::testing::Values(Damage::kFull, Damage::kMoving, Damage::kOverlapping,
                                                              Damage::kMany, Damage::kZero, Damage::kOutOfBounds)));

using WarpTest = testing::GlTest<>;

TEST_F(WarpTest, OddSizesMatchTheReference) {
  const Size desktop{117, 93};
  const auto picture = testing::testDesktop(desktop);
  for (const Size resolution : {Size{1, 1}, Size{3, 5}, Size{255, 1}, Size{129, 97}}) {
    auto one = makeCase(Shape::kIdentity, Alpha::kRamp, resolution, desktop);
    const auto shift = testing::identityMap({0.37, 0.81});
    one.plan.mesh = testing::meshOf(testing::gridOf(shift, resolution, 1, 1), desktop);
    one.job.desktopFromProjector = analytic(shift, desktop);
    WallRenderer renderer(context_);
    renderer.setPlans({one.plan});
    renderer.upload(testing::wholeBatch(picture));
    renderer.draw();
    EXPECT_LE(compare(renderer.readOutput(0), reference::warp(picture, one.job)).worst, 1.5) << resolution.width;
  }
}

TEST_F(WarpTest, FiltersTransfersAndResponsesMatchTheReference) {
  const Size desktop{331, 257};
  const auto picture = testing::testDesktop(desktop);
  std::vector<Case> cases;
  for (const auto filter : {Filter::kCatmullRom, Filter::kBilinear, Filter::kNearest}) {
    for (const bool linear : {false, true}) {
      for (const bool response : {false, true}) {
        auto one = makeCase(Shape::kHomography, Alpha::kRamp, {141, 101}, desktop);
        one.plan.filter = filter;
        one.plan.dither = response;
        one.job.kernel = static_cast<reference::Kernel>(filter);
        one.plan.transfer = linear ? DesktopTransfer::kLinear : DesktopTransfer::kSrgb;
        one.job.linearDesktop = linear;
        if (response) {
          for (int c = 0; c < 3; ++c) {
            auto& table = one.plan.inverseResponse[static_cast<std::size_t>(c)];
            const int entries = 200 + 312 * c;
            for (int i = 0; i < entries; ++i) {
              table.push_back(static_cast<float>(std::pow(i / (entries - 1.0), 1.1 - 0.1 * c)));
            }
          }
          one.job.deviceCode = [](double light, int c) { return std::pow(light, (1.1 - 0.1 * c) / 2.2); };
        }
        cases.push_back(one);
      }
    }
  }
  const auto plans = plansOf(cases);
  WallRenderer renderer(context_);
  renderer.setPlans(plans);
  renderer.upload(testing::wholeBatch(picture));
  renderer.draw();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto expected = reference::warp(picture, cases[i].job);
    if (cases[i].plan.filter != Filter::kNearest) {
      expectLike(renderer.readOutput(i), expected, "pipeline-" + std::to_string(i));
      continue;
    }
    // A nearest texel changes with the last bit of the position: a few pixels may take the neighbour's.
    const auto actual = renderer.readOutput(i);
    int far = 0;
    for (int y = 0; y < actual.height(); ++y) {
      for (int x = 0; x < actual.width(); ++x) {
        if (clearOfEdges(expected, x, y) && std::abs(actual.at(x, y) - expected.at(x, y)) > 1.5) ++far;
      }
    }
    EXPECT_LE(far, 5) << i;
  }
}

TEST_F(WarpTest, TiledIsUntiled) {
  // The same window of pixels, once around a corner where four tiles meet and once inside one tile.
  const Size big{2100, 2100};
  const auto picture = testing::testDesktop(big);
  const Size resolution{257, 193};
  const glm::ivec2 corner(kTileStride - 170, kTileStride - 130);
  Image8 small({400, 300}, 3);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) {
      for (int c = 0; c < 3; ++c) small.at(x, y, c) = picture.at(corner.x + x, corner.y + y, c);
    }
  }
  const auto map = testing::homographyMap(resolution, small.size());
  const WeightedMap moved = [&](glm::dvec2 p) {
    const auto at = map(p);
    return glm::dvec3(at.x + corner.x * at.z, at.y + corner.y * at.z, at.z);
  };
  // Ends of the picture are apart on purpose: here it is the desktop's border, there it goes on.
  WallRenderer tiled(context_);
  auto tiledPlan = testing::planOf("t", moved, resolution, big, 4, 4);
  tiledPlan.dither = false;
  EXPECT_EQ(tiledPlan.mesh.patches.size(), 4U);
  tiled.setPlans({tiledPlan});
  tiled.upload(testing::wholeBatch(picture));
  tiled.draw();
  WallRenderer untiled(context_);
  auto untiledPlan = testing::planOf("u", map, resolution, small.size(), 4, 4);
  untiledPlan.dither = false;
  untiled.setPlans({untiledPlan});
  untiled.upload(testing::wholeBatch(small));
  untiled.draw();
  const auto a = tiled.readOutput(0);
  const auto b = untiled.readOutput(0);
  std::int64_t compared = 0;
  for (int y = 0; y < resolution.height; ++y) {
    for (int x = 0; x < resolution.width; ++x) {
      const auto at = map({x + 0.5, y + 0.5});
      const glm::dvec2 p(at.x / at.z, at.y / at.z);
      if (p.x < 3 || p.y < 3 || p.x > 397 || p.y > 297) continue;
      ++compared;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(a.at(x, y, c), b.at(x, y, c), 1) << x << ", " << y;
    }
  }
  EXPECT_GT(compared, resolution.area() / 2);
}

TEST_F(WarpTest, CoversEveryPixelOfTheMeshAndNothingElse) {
  const Size desktop{2500, 1300};
  const Size resolution{1024, 768};
  const auto map = testing::bentMap(resolution, desktop);
  WallRenderer renderer(context_, {.measure = true});
  renderer.setPlans({testing::planOf("p", map, resolution, desktop, 32, 24)});
  renderer.uploadDesktop(devices::ImageF(desktop, 4));
  renderer.draw();
  const auto frame = renderer.readOutputFloat(0);
  std::int64_t wrong = 0;
  for (int y = 0; y < resolution.height; ++y) {
    for (int x = 0; x < resolution.width; ++x) {
      const auto weighted = map({x + 0.5, y + 0.5});
      const glm::dvec2 p(weighted.x / weighted.z, weighted.y / weighted.z);
      const double inside = std::min({p.x, p.y, desktop.width - p.x, desktop.height - p.y});
      if (std::abs(inside) < 4) continue;
      if ((frame.at(x, y, 3) == 1.0F) != (inside > 0)) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(WarpTest, ADesktopOfCoordinatesComesOutAsCoordinates) {
  const Size desktop{3840, 2160};
  devices::ImageF coordinates(desktop, 4);
  for (int y = 0; y < desktop.height; ++y) {
    for (int x = 0; x < desktop.width; ++x) {
      coordinates.at(x, y, 0) = static_cast<float>(x) + 0.5F;
      coordinates.at(x, y, 1) = static_cast<float>(y) + 0.5F;
    }
  }
  const Size resolution{3840, 2160};
  const auto map = testing::homographyMap(resolution, desktop);
  WallRenderer renderer(context_, {.measure = true});
  renderer.setPlans({testing::planOf("p", map, resolution, desktop, 16, 9)});
  renderer.uploadDesktop(coordinates);
  renderer.draw();
  const auto frame = renderer.readOutputFloat(0);
  double worst = 0;
  std::int64_t beyondThousandth = 0;
  std::int64_t compared = 0;
  for (int y = 0; y < resolution.height; ++y) {
    for (int x = 0; x < resolution.width; ++x) {
      const auto weighted = map({x + 0.5, y + 0.5});
      const glm::dvec2 p(weighted.x / weighted.z, weighted.y / weighted.z);
      if (p.x < 3 || p.y < 3 || p.x > desktop.width - 3 || p.y > desktop.height - 3) continue;
      const double error = glm::length(p - glm::dvec2(frame.at(x, y, 0), frame.at(x, y, 1)));
      worst = std::max(worst, error);
      if (error > 1e-3) ++beyondThousandth;
      ++compared;
    }
  }
  RecordProperty("worst_px", std::to_string(worst));
  EXPECT_GT(compared, resolution.area() / 2);
  // Where a tile border cuts a corner off a triangle the sliver is thinner than the rasteriser's grid of 1/256 px and
  // its corners are floats: there, and only there, the position may be off by that much.
  EXPECT_LE(worst, 1.0 / 256);
  EXPECT_LE(static_cast<double>(beyondThousandth), 1e-4 * static_cast<double>(compared));
}

TEST_F(WarpTest, DitherKeepsTheMeanAndTheEnds) {
  const Size size{256, 256};
  for (const double level : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    // Twenty codes, each dimmed by a mask so that the device value lies between two codes.
    Image8 desktop(size, 3);
    for (auto& sample : desktop.samples()) sample = level == 0.0 ? 0 : 255;
    auto plan = testing::planOf("p", testing::identityMap(), size, size, 1, 1);
    plan.transfer = DesktopTransfer::kLinear;
    plan.alpha = devices::Image16(size, 1);
    const double wanted = level == 1.0 ? 255 : 20 + level;
    for (auto& sample : plan.alpha.samples()) sample = static_cast<std::uint16_t>(std::lround(wanted / 255 * 65535));
    WallRenderer renderer(context_);
    renderer.setPlans({plan});
    renderer.upload(testing::wholeBatch(desktop));
    renderer.draw();
    const auto frame = renderer.readOutput(0);
    double sum = 0;
    for (const auto sample : frame.samples()) sum += sample;
    const double mean = sum / static_cast<double>(frame.samples().size());
    const double expected = level == 0.0 ? 0 : wanted;
    EXPECT_NEAR(mean, expected, level == 0.0 || level == 1.0 ? 0.0 : 0.01) << level;
    // And over any 16x16 pixels it is near: noise without large clumps.
    for (int y = 0; y < size.height; y += 16) {
      for (int x = 0; x < size.width; x += 16) {
        double block = 0;
        for (int j = 0; j < 16; ++j) {
          for (int i = 0; i < 16; ++i) block += frame.at(x + i, y + j, 1);
        }
        ASSERT_NEAR(block / 256, expected, 0.06) << level;
      }
    }
  }
}

}  // namespace
}  // namespace pixelflex::viewer
