// A dense projector inside a wide one: how much of fine stripes is left where each of the two shows them, of a model in
// one pass and in two and of the desktop, seen by the audience of a simulated wall.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <iostream>
#include <map>

#include "calib/geometry/projector_mapping.h"
#include "calib/simulate/rig_generator.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "viewer/model/triangle_soup.h"
#include "viewer/plan/close_up.h"
#include "viewer/plan/model_wall.h"

namespace pixelflex {
namespace {

using viewer::ModelWall;
using viewer::ModelWallOptions;
using viewer::WallPlan;

constexpr std::size_t kWide = 0;
constexpr std::size_t kInset = 1;
constexpr double kWhole = 4096;  // without a gap in sight: pixels of the wide one
constexpr int kPeriods = 8;      // that are looked at
constexpr int kSamples = 48;     // of a period

/// Upright stripes in the window's plane, as wide as the gaps between them.
viewer::Scene stripes(const viewer::WallWindow& window, double period) {
  viewer::TriangleSoup soup;
  const int count = static_cast<int>(window.extent.x / period) + 1;
  for (int i = 0; i < count; ++i) {
    const double left = i * period - 0.5 * window.extent.x;
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
      const glm::dvec2 at(left + 0.5 * period * corner.x, (corner.y - 0.5) * window.extent.y);
      soup.push_back({.position = glm::vec3(at, 0), .normal = {0, 0, 1}});
    }
  }
  viewer::Scene scene;
  scene.materials.push_back({.colour = glm::vec3(1), .lit = false});
  addToScene(soup, 0, scene);
  return scene;
}

class InsetWall {
 public:
  InsetWall()
      : room_(calib::insetRig(1)),
        calibrated_(calib::calibrateRig(room_, folder_.path(), calib::Method::kBlobs, {.priorityFeather = 60})),
        plan_(folder_.path(), calibrated_.wall, calibrated_.calibration, {}) {
    stripe_ = kWhole;
    white_ = model({});
  }

  /// And its gap, in pixels of the wide projector.
  void setStripe(double pixels) { stripe_ = pixels; }

  [[nodiscard]] const WallPlan& plan() const { return plan_; }
  [[nodiscard]] double period() const {
    return stripe_ / calib::ProjectorMapping(*plan_.projectors()[kWide]).meanDensity();
  }

  std::vector<devices::Image8> model(const ModelWallOptions& options) {
    devices::HeadlessContext context;
    ModelWall model(context, plan_, options);
    show(model);
    return {model.read(kWide), model.read(kInset)};
  }

  /// Where the inset's second pass puts the white model beside where its calibration does: the largest distance in the
  /// inset's pixels, at `count` pixels.
  double closeUpError(std::size_t& count) {
    setStripe(kWhole);
    devices::HeadlessContext context;
    ModelWall model(context, plan_, {.passes = 2, .model = {.measure = true}});
    show(model);
    const auto frame = model.readFloat(kInset);
    const calib::ProjectorMapping mapping(*plan_.projectors()[kInset]);
    const auto& display = plan_.display();
    const glm::dvec2 middle(0.5 * (display.left + display.right), 0.5 * (display.top + display.bottom));
    double largest = 0;
    for (int y = 2; y < frame.height() - 2; y += 5) {
      for (int x = 2; x < frame.width() - 2; x += 5) {
        if (frame.at(x, y, 3) < 1) continue;
        const glm::dvec2 shown = middle + glm::dvec2(frame.at(x, y, 0), -frame.at(x, y, 1));
        const auto there = mapping.projectorFromWall(shown);
        largest = std::max(largest, there ? glm::distance(*there, glm::dvec2(x + 0.5, y + 0.5)) : 1e9);
        ++count;
      }
    }
    return largest;
  }

  /// The model's picture on the desktop, shown as any desktop is.
  std::vector<devices::Image8> desktop() {
    devices::HeadlessContext context;
    ModelWall model(context, plan_, {.desktop = true});
    show(model);
    viewer::WallRenderer renderer(context);
    renderer.setPlans(plan_.outputsFor(plan_.desktop()));
    renderer.copyDesktop(model.desktopTexture(0));
    renderer.draw();
    return {renderer.readOutput(kWide), renderer.readOutput(kInset)};
  }

  /// The first harmonic of what the audience sees there, over that of stripes of the light `white` which lose nothing.
  [[nodiscard]] double kept(const std::vector<devices::Image8>& frames, double white, glm::dvec2 at) const {
    std::complex<double> sum;
    const auto light = lightAround(frames, at);
    for (int y = 0; y < light.height(); ++y) {
      for (int x = 0; x < light.width(); ++x) sum += std::polar<double>(light.at(x, y, 1), 2 * M_PI * x / kSamples);
    }
    return std::abs(sum) / static_cast<double>(light.size().area()) / white * M_PI;
  }
  [[nodiscard]] double whiteAt(glm::dvec2 at) const {
    const auto light = lightAround(white_, at);
    double sum = 0;
    for (int i = 0; i < light.width(); ++i) sum += light.at(i, 0, 1);
    return sum / light.width();
  }

  [[nodiscard]] glm::dvec2 middleOf(std::size_t projector) const {
    return room_.wallFromProjector(projector, {512, 384}).value();
  }

  /// Lit by the wide one alone: beside the inset, on the side where more of the frame is left.
  [[nodiscard]] glm::dvec2 beside() const {
    const glm::dvec2 middle = middleOf(kInset);
    const glm::dvec2 edge = room_.wallFromProjector(kInset, {1024, 384}).value();
    const double side = middle.x > middleOf(kWide).x ? -1 : 1;
    return middle + side * 1.5 * glm::dvec2(std::abs(edge.x - middle.x), 0);
  }

 private:
  [[nodiscard]] devices::ImageF lightAround(const std::vector<devices::Image8>& frames, glm::dvec2 at) const {
    const double half = 0.5 * kPeriods * period();
    return room_.audienceLight(frames, at - half, at + half, {kPeriods * kSamples, 8});
  }
  void show(ModelWall& model) const {
    const auto window = viewer::windowOf(plan_.display());
    model.setScene(stripes(window, period()));
    viewer::ModelView view{.window = window, .viewer = viewer::centredViewer(window)};
    const glm::dvec2 extent = model.bounds().high - model.bounds().low;
    view.pose.zoom = 0.5 * glm::length(extent) / radiusInWindow(view.pose, model.bounds(), window);
    view.pose.shift = glm::dvec3(model.bounds().middle()) / std::min(window.extent.x, window.extent.y);
    model.setView(view);
    model.draw();
  }

  calib::SimulatedWall room_;
  testing::TemporaryFolder folder_;
  calib::CalibratedRig calibrated_;
  WallPlan plan_;
  double stripe_ = 1;
  std::vector<devices::Image8> white_;
};

TEST(ModelInset, ShowsItsPartSharper) {
  InsetWall wall;
  const auto closeUp = viewer::closeUpOf(wall.plan(), kInset);
  ASSERT_TRUE(closeUp);
  EXPECT_FALSE(viewer::closeUpOf(wall.plan(), kWide));
  EXPECT_NEAR(closeUp->resolution.width, 1024, 150);
  std::size_t compared = 0;
  const double error = wall.closeUpError(compared);
  std::cout << "close-up: " << error << " px at most from the calibration, of " << compared << " pixels\n";
  EXPECT_GT(compared, 20'000U);
  EXPECT_LE(error, 0.1);
  const glm::dvec2 inInset = wall.middleOf(kInset);
  for (const double stripe : {2.0, 1.2}) {
    wall.setStripe(stripe);
    std::map<std::string, double> kept;
    for (const auto& [name, frames] : {std::pair("desktop", wall.desktop()), std::pair("one pass", wall.model({})),
                                       std::pair("two passes", wall.model({.passes = 2}))}) {
      kept[name] = wall.kept(frames, wall.whiteAt(inInset), inInset);
      const double beside = wall.kept(frames, wall.whiteAt(wall.beside()), wall.beside());
      std::cout << name << ": stripes of " << stripe << " wide pixels keep " << kept[name]
                << " of their contrast in the inset, " << beside << " beside it\n";
      EXPECT_GT(kept[name], 1.5 * beside) << name;
    }
    if (stripe == 2) continue;
    // Finer than the desktop's own pixels show.
    EXPECT_GT(kept["one pass"], 1.3 * kept["desktop"]);
    EXPECT_GT(kept["two passes"], 1.3 * kept["desktop"]);
  }
}

}  // namespace
}  // namespace pixelflex
