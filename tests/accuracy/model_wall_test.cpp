// A model on simulated walls against ground truth: one pass, one pass with the lens at the vertices, and two.
#include <gmock/gmock.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <iostream>

#include "calib/simulate/rig.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/calibrated_rig.h"
#include "tests/support_calibration/registration.h"
#include "viewer/model/triangle_soup.h"
#include "viewer/plan/model_wall.h"

namespace pixelflex {
namespace {

using calib::RegistrationFigures;
using calib::SimulatedWall;
using viewer::ModelWall;
using viewer::ModelWallOptions;
using viewer::WallPlan;

/// A sheet in the window's plane, a little larger than it, of squares about 30 projector pixels wide.
viewer::Scene sheet(const viewer::WallWindow& window) {
  constexpr int kColumns = 150;
  constexpr int kRows = 60;
  const glm::dvec2 size = 1.02 * window.extent;
  viewer::TriangleSoup soup;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
        const glm::dvec2 at =
            (glm::dvec2(column + corner.x, row + corner.y) / glm::dvec2(kColumns, kRows) - 0.5) * size;
        soup.push_back({.position = glm::vec3(at, 0), .normal = {0, 0, 1}});
      }
    }
  }
  viewer::Scene scene;
  scene.materials.emplace_back();
  addToScene(soup, 0, scene);
  return scene;
}

/// What each projector of the rig shows, as desktop pixels: an ideal camera in the eye's place would see the sheet's
/// every point where it is in the window.
std::vector<devices::ImageF> shownBy(ModelWall& model, const calib::Rig& rig, const calib::Display& display) {
  const auto window = viewer::windowOf(display);
  const glm::dvec2 resolution(display.resolution.width, display.resolution.height);
  std::vector<devices::ImageF> shown(rig.projectors.size());
  for (std::size_t i = 0; i < model.projectorCount(); ++i) {
    auto frame = model.readFloat(i);
    for (int y = 0; y < frame.height(); ++y) {
      for (int x = 0; x < frame.width(); ++x) {
        const glm::dvec2 inWindow(frame.at(x, y, 0), -frame.at(x, y, 1));
        const glm::dvec2 inDesktop = (inWindow / window.extent + 0.5) * resolution;
        frame.at(x, y, 0) = static_cast<float>(inDesktop.x);
        frame.at(x, y, 1) = static_cast<float>(inDesktop.y);
      }
    }
    const auto found = std::ranges::find(rig.projectors, model.name(i), &calib::SimulatedProjectorSpec::name);
    shown.at(static_cast<std::size_t>(found - rig.projectors.begin())) = std::move(frame);
  }
  return shown;
}

/// A calibrated wall and the figures of models on it.
class ShownModel {
 public:
  explicit ShownModel(calib::Rig rig)
      : room_(std::move(rig)),
        calibrated_(calib::calibrateRig(room_, folder_.path())),
        plan_(folder_.path(), calibrated_.wall, calibrated_.calibration, {}) {}

  RegistrationFigures figures(const std::string& name, ModelWallOptions options) {
    options.model.measure = true;
    ModelWall model(context_, plan_, options);
    const auto window = viewer::windowOf(plan_.display());
    model.setScene(sheet(window));
    viewer::ModelView view{.window = window, .viewer = viewer::centredViewer(window)};
    const glm::dvec2 extent = model.bounds().high - model.bounds().low;
    view.pose.zoom = 0.5 * glm::length(extent) / radiusInWindow(view.pose, model.bounds(), window);
    model.setView(view);
    model.draw();
    fits = model.fits();
    const auto shown = shownBy(model, room_.rig(), plan_.display());
    const auto meant = calib::meantByPictures(plan_.display(), shown);
    print(name, meant);
    return calib::measureRegistration(room_, meant);
  }

  std::vector<viewer::OnePassFit> fits;

 private:
  /// At seams alone, each projector beside the ideal camera.
  void print(const std::string& name, const calib::MeantPlace& meant) {
    const auto atSeams = [&](std::size_t projector, glm::dvec2 p) -> std::optional<glm::dvec2> {
      const auto onWall = room_.wallFromProjector(projector, p);
      for (std::size_t other = 0; onWall && other < room_.projectorCount(); ++other) {
        const auto there = other == projector ? std::nullopt : room_.projectorFromWall(other, *onWall);
        if (there && meant(other, *there)) return meant(projector, p);
      }
      return std::nullopt;
    };
    const auto figures = calib::measureRegistration(room_, atSeams);
    for (std::size_t i = 0; i < figures.registration.size(); ++i) {
      std::cout << name << " at seams, " << room_.rig().projectors[i].name << ": "
                << calib::text(figures.registration[i]) << "\n";
    }
    std::cout << name << " across seams: " << calib::text(figures.seam) << "\n";
  }

  SimulatedWall room_;
  testing::TemporaryFolder folder_;
  calib::CalibratedRig calibrated_;
  WallPlan plan_;
  devices::HeadlessContext context_;
};

calib::Rig reportRig() {
  return calib::loadRig(PIXELFLEX_SOURCE_DIR "/config/rigs/report-8.yaml");
}

TEST(ModelWall, OnTheReportRigIsAsExactAsItSays) {
  ShownModel wall(reportRig());
  const auto one = wall.figures("one pass", {});
  ASSERT_EQ(one.registration.size(), wall.fits.size());
  for (std::size_t i = 0; i < wall.fits.size(); ++i) {
    EXPECT_NEAR(one.registration[i].rms, wall.fits[i].rms, 0.05) << i;
    EXPECT_LE(one.registration[i].maximum, wall.fits[i].maximum + 0.15) << i;
  }
  const auto corners = wall.figures("four corners", {.features = viewer::Features::kCorners});
  EXPECT_LT(one.all.rms, corners.all.rms);
  const auto lens = wall.figures("lens at vertices", {.lensAtVertices = true});
  EXPECT_LE(lens.seam.rms, 0.1);
  EXPECT_LE(lens.seam.maximum, 0.3);
  const auto two = wall.figures("two passes", {.passes = 2});
  EXPECT_LE(two.seam.rms, 0.1);
  EXPECT_LE(two.seam.maximum, 0.3);
  EXPECT_GT(two.seam.count, 100'000U);
}

TEST(ModelWall, WithNearLinearLensesNeedsOnlyOnePass) {
  auto rig = reportRig();
  for (auto& projector : rig.projectors) {
    for (auto& term : projector.optics.radial) term *= 0.2;
    for (auto& term : projector.optics.tangential) term *= 0.2;
  }
  ShownModel wall(std::move(rig));
  const auto one = wall.figures("one pass, near-linear lenses", {});
  EXPECT_LE(one.seam.rms, 0.5);
  for (const auto& fit : wall.fits) EXPECT_LE(fit.maximum, viewer::kLargestOnePassError);
}

}  // namespace
}  // namespace pixelflex
