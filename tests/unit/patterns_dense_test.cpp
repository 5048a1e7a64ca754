// Dense structured light against the simulator's ground truth, with which it shares no geometry code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "calib/patterns/dense_decoder.h"
#include "calib/patterns/dense_pattern.h"
#include "calib/patterns/method.h"
#include "calib/simulate/rig_generator.h"
#include "calib/simulate/simulated_wall.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;

CameraIntrinsics trueCamera(const Rig& rig) {
  const Optics& optics = rig.camera.optics;
  CameraIntrinsics camera;
  camera.size = rig.camera.size;
  camera.fx = camera.fy = optics.focal;
  camera.cx = optics.principal.x;
  camera.cy = optics.principal.y;
  camera.radial = optics.radial;
  camera.tangential = optics.tangential;
  return camera;
}

std::vector<Image8> shootAll(SimulatedWall& wall, std::size_t projector) {
  std::vector<Image8> photos;
  for (const auto& pattern : densePatterns(wall.projector(projector).resolution())) {
    wall.projector(projector).show(pattern.render());
    photos.push_back(wall.camera().shoot());
  }
  wall.projector(projector).blank();
  return photos;
}

/// A small wall and all photographs of its first projector, shared by the tests that spoil them.
struct Shoot {
  SimulatedWall wall;
  CameraMapping camera;
  std::vector<Image8> photos;
  explicit Shoot(const Rig& rig) : wall(rig), camera(trueCamera(rig)), photos(shootAll(wall, 0)) {}
  [[nodiscard]] devices::Size resolution() const { return wall.rig().projectors[0].resolution; }
  [[nodiscard]] DenseSamples decode() const { return decodeDense(photos, resolution(), camera); }
};

const Shoot& sharedShoot() {
  static const Shoot shoot(miniRig(3));
  return shoot;
}

struct Errors {
  double rms = 0;
  double max = 0;
  glm::dvec2 bias{0, 0};
};

/// Of samples against the wall's truth, in projector pixels: where the light seen at the sample comes from, minus where
/// it says.
Errors errorsOf(const SimulatedWall& wall, const CameraMapping& camera, const std::vector<DenseSample>& samples) {
  Errors errors;
  const auto inRaw = [&](glm::dvec2 p) { return wall.cameraFromWall(*wall.wallFromProjector(0, p)).value(); };
  for (const auto& sample : samples) {
    const glm::dvec2 p = sample.pointInProjector;
    const glm::dvec2 off = camera.rawFromUndistorted(sample.pointInUndistorted) - inRaw(p);
    const glm::dvec2 byX = inRaw(p + glm::dvec2(0.5, 0)) - inRaw(p - glm::dvec2(0.5, 0));
    const glm::dvec2 byY = inRaw(p + glm::dvec2(0, 0.5)) - inRaw(p - glm::dvec2(0, 0.5));
    const double det = byX.x * byY.y - byX.y * byY.x;
    const glm::dvec2 error((off.x * byY.y - off.y * byY.x) / det, (byX.x * off.y - byX.y * off.x) / det);
    errors.bias += error / static_cast<double>(samples.size());
    errors.rms += (error.x * error.x + error.y * error.y) / static_cast<double>(samples.size());
    errors.max = std::max(errors.max, std::hypot(error.x, error.y));
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

/// Records the figures too, for whoever reads the test's XML.
Errors measured(const Shoot& shoot, const DenseSamples& decoded) {
  const Errors errors = errorsOf(shoot.wall, shoot.camera, decoded.samples);
  testing::Test::RecordProperty("rms", std::to_string(errors.rms));
  testing::Test::RecordProperty("max", std::to_string(errors.max));
  testing::Test::RecordProperty("bias", std::to_string(std::hypot(errors.bias.x, errors.bias.y)));
  return errors;
}

/// The set-up whose figures count: 0.42 camera pixels per projector pixel.
Rig coarseRig(std::uint32_t seed) {
  return casualRig(2, 1, {1024, 768}, seed, {960, 600});
}

TEST(DensePattern, NamesAreTheFilesOfEveryPicture) {
  const DenseLayout layout({1024, 768});
  EXPECT_EQ(layout.x().period(), 16);
  EXPECT_EQ(layout.x().bits(), 7);
  std::set<std::string> names;
  for (const auto& pattern : densePatterns({1024, 768})) {
    EXPECT_FALSE(pattern.description.empty());
    EXPECT_EQ(pattern.render().size(), (devices::Size{1024, 768}));
    EXPECT_EQ(pattern.render().channels(), 1);
    names.insert(pattern.name);
  }
  EXPECT_EQ(names.size(), DenseOrder(layout).count);
  for (const char* name : {"dense-black", "dense-white", "dense-column0", "dense-row6", "dense-xphase7"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(DensePattern, NeighbouringCellsDifferInOneBit) {
  const DenseAxis axis(1080, 32);
  for (int pixel = 16; pixel < axis.length(); pixel += 16) {
    int changes = 0;
    for (int bit = 0; bit < axis.bits(); ++bit) changes += axis.grayCode(pixel, bit) != axis.grayCode(pixel - 1, bit);
    EXPECT_EQ(changes, 1) << pixel;
  }
}

TEST(DensePattern, LatticeReachesTheBorder) {
  for (const devices::Size size : {devices::Size{1920, 1080}, devices::Size{768, 1024}, devices::Size{640, 480}}) {
    const DenseLayout layout(size);
    EXPECT_EQ(std::max(layout.columns(), layout.rows()), 48);
    const glm::dvec2 last = layout.point(layout.columns() - 1, layout.rows() - 1);
    EXPECT_NEAR(layout.point(0, 0).x, size.width - last.x, 1e-9);
    EXPECT_NEAR(layout.point(0, 0).y, size.height - last.y, 1e-9);
    EXPECT_LE(layout.point(0, 0).x, 0.006 * std::max(size.width, size.height));
  }
}

TEST(DensePattern, MethodsKnowTheirPictures) {
  EXPECT_EQ(methodName(Method::kDense), "dense");
  EXPECT_EQ(methodName(Method::kBlobs), "blobs");
  EXPECT_EQ(patternsOf(Method::kDense, {640, 480}).front().name, "dense-black");
  EXPECT_EQ(patternsOf(Method::kBlobs, {640, 480}).front().name, "black");
}

TEST(DenseDecoder, MeasuresToAHundredthOfAPixelWithACoarseCamera) {
  const Shoot shoot(coarseRig(1));
  const DenseSamples decoded = shoot.decode();
  EXPECT_EQ(static_cast<int>(decoded.samples.size()), decoded.shown);
  EXPECT_EQ(decoded.hint, "");
  EXPECT_NEAR(decoded.cameraScale, 0.42, 0.03);
  EXPECT_EQ(decoded.saturatedShare, 0);
  const Errors errors = measured(shoot, decoded);
  EXPECT_LT(errors.rms, 0.01);
  EXPECT_LT(errors.max, 0.04);
  EXPECT_LT(std::hypot(errors.bias.x, errors.bias.y), 0.003);
}

TEST(DenseDecoder, TheProjectorsResponseLeavesNoBias) {
  Rig rig = miniRig(5);
  rig.projectors[0].response.gamma = {1.9, 2.2, 2.5};
  rig.projectors[0].response.toe = 0.08;
  const Shoot shoot(rig);
  const DenseSamples decoded = shoot.decode();
  EXPECT_EQ(static_cast<int>(decoded.samples.size()), decoded.shown) << decoded.hint;
  const Errors errors = measured(shoot, decoded);
  EXPECT_LT(errors.rms, 0.01);
  EXPECT_LT(std::hypot(errors.bias.x, errors.bias.y), 0.003);
}

TEST(DenseDecoder, ACamerasGammaLeavesNoBias) {
  Rig rig = miniRig(6);
  rig.camera.gamma = 2.2;
  const Shoot shoot(rig);
  const DenseSamples decoded = shoot.decode();
  EXPECT_EQ(static_cast<int>(decoded.samples.size()), decoded.shown) << decoded.hint;
  const Errors errors = measured(shoot, decoded);
  EXPECT_LT(errors.rms, 0.01);
  EXPECT_LT(std::hypot(errors.bias.x, errors.bias.y), 0.003);
}

/// Photographs of the shared shoot with something done to them.
DenseSamples decodeSpoiled(const std::function<void(std::vector<Image8>&)>& spoil) {
  auto photos = sharedShoot().photos;
  spoil(photos);
  return decodeDense(photos, sharedShoot().resolution(), sharedShoot().camera);
}

/// Whatever is handed back must still be right.
void expectTrue(const DenseSamples& decoded) {
  if (decoded.samples.empty()) return;
  EXPECT_LT(errorsOf(sharedShoot().wall, sharedShoot().camera, decoded.samples).max, 0.5);
}

/// Something dark before the wall, in these columns of every photograph from this row down.
void standBefore(std::vector<Image8>& photos, int left, int right, int top) {
  for (auto& photo : photos) {
    for (int y = top; y < photo.height(); ++y) {
      for (int x = left; x < right; ++x) {
        for (int c = 0; c < 3; ++c) photo.at(x, y, c) = 12;
      }
    }
  }
}

TEST(DenseDecoder, APersonInFrontCostsOnlyWhatTheyHide) {
  const DenseSamples decoded = decodeSpoiled([](auto& photos) { standBefore(photos, 250, 330, 200); });
  EXPECT_GT(decoded.samples.size(), decoded.shown * 0.6);
  EXPECT_LT(decoded.samples.size(), decoded.shown * 0.95);
  EXPECT_THAT(decoded.hint, testing::HasSubstr("hidden"));
  expectTrue(decoded);
}

TEST(DenseDecoder, SomethingAcrossTheFrameDoesNotCostTheFartherHalf) {
  const DenseSamples decoded = decodeSpoiled([](auto& photos) { standBefore(photos, 260, 290, 0); });
  EXPECT_GT(decoded.samples.size(), decoded.shown * 0.8);
  expectTrue(decoded);
}

TEST(DenseDecoder, SaysWhatIsWrongWithThePhotographs) {
  using testing::HasSubstr;
  const auto swapped = decodeSpoiled([](auto& photos) { std::swap(photos[0], photos[1]); });
  EXPECT_TRUE(swapped.samples.empty());
  EXPECT_THAT(swapped.hint, HasSubstr("swapped"));
  const auto dark = decodeSpoiled([](auto& photos) { photos[1] = photos[0]; });
  EXPECT_TRUE(dark.samples.empty());
  EXPECT_THAT(dark.hint, HasSubstr("is the projector on"));
  const auto sizes = decodeSpoiled([](auto& photos) { photos[5] = Image8({960, 599}, 3); });
  EXPECT_TRUE(sizes.samples.empty());
  EXPECT_THAT(sizes.hint, HasSubstr("differ in size"));
  const auto grey = decodeSpoiled([](auto& photos) { photos[5] = Image8({960, 600}, 1); });
  EXPECT_TRUE(grey.samples.empty());
  const auto bright = decodeSpoiled([](auto& photos) {
    for (auto& photo : photos) {
      for (auto& code : photo.samples()) code = static_cast<std::uint8_t>(std::min(255, 2 * code));
    }
  });
  EXPECT_THAT(bright.hint, HasSubstr("over-exposed"));
  EXPECT_GT(bright.saturatedShare, 0.05);
}

TEST(DenseDecoder, NoticesPhotographsOfTheWrongPattern) {
  const std::size_t count = sharedShoot().photos.size();
  for (std::size_t first = DenseOrder::kWhite + 1; first + 1 < count; first += 2) {
    const auto decoded = decodeSpoiled([&](auto& photos) { std::swap(photos[first], photos[first + 1]); });
    EXPECT_LT(decoded.samples.size(), decoded.shown * 0.5) << first;
    EXPECT_THAT(decoded.hint, testing::HasSubstr("contradict")) << first;
    expectTrue(decoded);
  }
}

TEST(DenseDecoder, NoticesACameraThatWasMoved) {
  const DenseOrder order(DenseLayout(sharedShoot().resolution()));
  for (const std::size_t pixels : {1, 3, 20}) {
    const auto decoded = decodeSpoiled([&](auto& photos) {
      for (std::size_t i = order.xWave; i < photos.size(); ++i) {
        Image8 moved(photos[i].size(), 3);
        for (int y = 0; y < moved.height(); ++y) {
          std::ranges::copy(photos[i].row(y).subspan(3 * pixels), moved.row(y).begin());
        }
        photos[i] = moved;
      }
    });
    EXPECT_TRUE(decoded.samples.empty()) << pixels;
    EXPECT_THAT(decoded.hint, testing::HasSubstr("contradict")) << pixels;
  }
}

TEST(DenseDecoder, SaysWhenTheFrameIsCutOff) {
  const auto decoded = decodeSpoiled([](auto& photos) {
    for (auto& photo : photos) {
      Image8 left({photo.width() / 3, photo.height()}, 3);
      for (int y = 0; y < left.height(); ++y) {
        std::ranges::copy(photo.row(y).first(left.row(y).size()), left.row(y).begin());
      }
      photo = left;
    }
  });
  EXPECT_GT(decoded.samples.size(), decoded.shown / 3);
  EXPECT_LT(static_cast<int>(decoded.samples.size()), decoded.shown);
  EXPECT_THAT(decoded.hint, testing::HasSubstr("outside the photograph"));
  expectTrue(decoded);
}

TEST(DenseDecoder, NoiseAloneIsNotAFrame) {
  std::vector<Image8> photos(sharedShoot().photos.size(), Image8({320, 200}, 3));
  std::uint32_t state = 7;
  for (auto& photo : photos) {
    for (auto& code : photo.samples()) code = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24);
  }
  const auto decoded = decodeDense(photos, sharedShoot().resolution(), CameraMapping());
  EXPECT_TRUE(decoded.samples.empty());
  EXPECT_FALSE(decoded.hint.empty());
}

}  // namespace
}  // namespace pixelflex::calib
