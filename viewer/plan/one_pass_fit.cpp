#include "viewer/plan/one_pass_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <span>

#include "calib/geometry/projector_mapping.h"
#include "calib/photometric/stacks.h"

namespace pixelflex::viewer {
namespace {

struct Pair {
  glm::dvec2 inDesktop;    // clip coordinates
  glm::dvec2 inProjector;  // clip coordinates
};

glm::dvec2 clipFromWall(glm::dvec2 pointInWall, const calib::Display& display) {
  const glm::dvec2 corner(display.left, display.top);
  return 2.0 * (pointInWall - corner) / (glm::dvec2(display.right, display.bottom) - corner) - 1.0;
}

glm::dvec2 wallFromClip(glm::dvec2 clip, const calib::Display& display) {
  const glm::dvec2 corner(display.left, display.top);
  return corner + 0.5 * (clip + 1.0) * (glm::dvec2(display.right, display.bottom) - corner);
}

glm::dvec2 map(const glm::dmat3& matrix, glm::dvec2 p) {
  const glm::dvec3 mapped = matrix * glm::dvec3(p, 1);
  return glm::dvec2(mapped) / mapped.z;
}

/// The homography of eight unknowns that takes points around the origin to the frame, least squares in pixels: a linear
/// start and Gauss and Newton's steps.
class HomographyFit {
 public:
  HomographyFit(std::span<const Pair> pairs, glm::dvec2 pixelsPerClip) : pairs_(pairs), pixels_(pixelsPerClip) {}

  glm::dmat3 solve() {
    h_.setZero();
    // With no denominator yet a step is the linear solution: the one whose algebraic error is least.
    step(true);
    for (int i = 0; i < 6 && pairs_.size() > 4; ++i) step(false);
    return {{h_(0), h_(3), h_(6)}, {h_(1), h_(4), h_(7)}, {h_(2), h_(5), 1}};
  }

 private:
  void step(bool algebraic) {
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix<double, 8, 1> right = Eigen::Matrix<double, 8, 1>::Zero();
    for (const auto& [from, to] : pairs_) {
      const double w = algebraic ? 1 : h_(6) * from.x + h_(7) * from.y + 1;
      for (int axis = 0; axis < 2; ++axis) {
        const int row = 3 * axis;
        const double now = algebraic ? 0 : (h_(row) * from.x + h_(row + 1) * from.y + h_(row + 2)) / w;
        const double at = algebraic ? to[axis] : now;
        Eigen::Matrix<double, 8, 1> slope = Eigen::Matrix<double, 8, 1>::Zero();
        slope.segment<3>(row) << from.x, from.y, 1;
        slope.segment<2>(6) << -at * from.x, -at * from.y;
        slope *= pixels_[axis] / w;
        normal += slope * slope.transpose();
        right += slope * (to[axis] - now) * pixels_[axis];
      }
    }
    h_ += normal.colPivHouseholderQr().solve(right);
  }

  std::span<const Pair> pairs_;
  glm::dvec2 pixels_;
  Eigen::Matrix<double, 8, 1> h_;
};

glm::dmat3 fitHomography(std::span<const Pair> pairs, glm::dvec2 pixelsPerClip) {
  glm::dvec2 middle(0);
  for (const auto& pair : pairs) middle += pair.inDesktop / static_cast<double>(pairs.size());
  std::vector<Pair> centred(pairs.begin(), pairs.end());
  double spread = 1e-9;
  for (auto& pair : centred) {
    pair.inDesktop -= middle;
    spread = std::max(spread, glm::length(pair.inDesktop));
  }
  for (auto& pair : centred) pair.inDesktop /= spread;
  const glm::dmat3 centredFromDesktop({1 / spread, 0, 0}, {0, 1 / spread, 0},
                                      {-middle.x / spread, -middle.y / spread, 1});
  return HomographyFit(centred, pixelsPerClip).solve() * centredFromDesktop;
}

std::vector<Pair> cornersOf(const std::vector<Pair>& all) {
  std::vector<Pair> corners;
  for (const glm::dvec2 corner : std::array<glm::dvec2, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}) {
    corners.push_back(*std::ranges::min_element(
        all, {}, [corner](const Pair& pair) { return glm::distance(pair.inProjector, corner); }));
  }
  return corners;
}

/// One projector's fit.
class OnePass {
 public:
  OnePass(const calib::ProjectorCalibration& projector, const calib::Display& display)
      : projector_(projector), display_(display), mapping_(projector) {}

  OnePassFit fit(Features features) const {
    std::vector<Pair> pairs;
    for (const auto& sample : projector_.samples) {
      const auto onWall = mapping_.wallFromProjector(sample.pointInProjector);
      if (onWall) {
        pairs.push_back(
            {clipFromWall(*onWall, display_), clipFromPixel(sample.pointInProjector, projector_.resolution)});
      }
    }
    if (pairs.size() < 4)
      throw PlanError("projector " + projector_.name + ": fewer than four features; calibrate again");
    if (features == Features::kCorners) pairs = cornersOf(pairs);
    OnePassFit result;
    result.projectorFromDesktop = fitHomography(pairs, pixelsPerClip());
    measure(result);
    result.lens = latticeOf(result.projectorFromDesktop);
    return result;
  }

 private:
  [[nodiscard]] glm::dvec2 pixelsPerClip() const {
    return 0.5 * glm::dvec2(projector_.resolution.width, projector_.resolution.height);
  }

  void measure(OnePassFit& fit) const {
    constexpr int kSteps = 40;
    double squares = 0;
    int count = 0;
    for (int row = 0; row <= kSteps; ++row) {
      for (int column = 0; column <= kSteps; ++column) {
        const glm::dvec2 clip(2.0 * column / kSteps - 1, 2.0 * row / kSteps - 1);
        const auto onWall = mapping_.wallFromProjector((clip + 1.0) * pixelsPerClip());
        if (!onWall) continue;
        const glm::dvec2 inDesktop = clipFromWall(*onWall, display_);
        if (std::max(std::abs(inDesktop.x), std::abs(inDesktop.y)) > 1) continue;
        const double error = glm::length((map(fit.projectorFromDesktop, inDesktop) - clip) * pixelsPerClip());
        squares += error * error;
        fit.maximum = std::max(fit.maximum, error);
        ++count;
      }
    }
    if (count > 0) fit.rms = std::sqrt(squares / count);
  }

  /// From where the straight drawing puts a point to where the lens does.
  [[nodiscard]] std::optional<glm::dvec2> shiftAt(glm::dvec2 clip, const glm::dmat3& desktopFromProjector) const {
    const auto there = mapping_.projectorFromWall(wallFromClip(map(desktopFromProjector, clip), display_));
    if (!there) return std::nullopt;
    return clipFromPixel(*there, projector_.resolution) - clip;
  }

  [[nodiscard]] LensLattice latticeOf(const glm::dmat3& projectorFromDesktop) const {
    const glm::dmat3 inverse = glm::inverse(projectorFromDesktop);
    LensLattice lattice{.columns = 65, .rows = 65};
    const double reach = 1 + 2 * kLensMargin;
    for (int row = 0; row < lattice.rows; ++row) {
      for (int column = 0; column < lattice.columns; ++column) {
        const glm::dvec2 clip =
            reach * (2.0 * glm::dvec2(column, row) / glm::dvec2(lattice.columns - 1, lattice.rows - 1) - 1.0);
        // Far outside, where the lens model may say nothing, the border's shift serves.
        auto shift = shiftAt(clip, inverse);
        if (!shift) shift = shiftAt(glm::clamp(clip, -1.0, 1.0), inverse);
        lattice.shifts.emplace_back(shift.value_or(glm::dvec2(0)));
      }
    }
    return lattice;
  }

  const calib::ProjectorCalibration& projector_;
  const calib::Display& display_;
  calib::ProjectorMapping mapping_;
};

}  // namespace

OnePassFit fitOnePass(const calib::ProjectorCalibration& projector, const calib::Display& display, Features features) {
  return OnePass(projector, display).fit(features);
}

std::vector<Eye> eyesOfProjectors(const WallPlan& wall) {
  std::vector<Eye> eyes(wall.projectors().size(), Eye::kMiddle);
  if (wall.wall().blend.stack != calib::StackRule::kLeftRight) return eyes;
  // Of all of them: the partner of one that is shown may be one that is not.
  const auto& all = wall.calibration().projectors;
  const std::vector<calib::ProjectorMapping> mappings(all.begin(), all.end());
  const auto partners = calib::stackPartners(mappings);
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    const auto index = static_cast<std::size_t>(wall.projectors()[i] - all.data());
    if (partners[index]) eyes[i] = index < *partners[index] ? Eye::kLeft : Eye::kRight;
  }
  return eyes;
}

OutputPlan lightPlanOf(const WallPlan& wall, std::size_t index) {
  OutputPlan plan = wall.lightFor(index, wall.desktop());
  if (wall.projectors().at(index)->flatAt) plan.inverseResponse = {};
  return plan;
}

WallWindow windowOf(const calib::Display& display) {
  return {{display.right - display.left, display.bottom - display.top}};
}

}  // namespace pixelflex::viewer
