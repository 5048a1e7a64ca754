#include "calib/estimate/fiducial_check.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace pixelflex::calib {
namespace {

constexpr double kFits = 2.5;         // camera pixels RMS up to which nothing is said: a tape measure's errors
constexpr double kMuchBetter = 5;     // times less misfit makes an explanation one
constexpr double kOutOfShape = 0.02;  // of a plane's axes, seen by the camera: unequal or oblique
constexpr double kNoPlane = 1e9;

using Pairs = std::vector<PointPair>;

/// How well pairs agree with a flat wall before this camera.
struct Fit {
  double misfit = kNoPlane;  // camera pixels RMS
  double shape = kNoPlane;   // relative difference in length of the wall's axes, or the cosine between them
  bool mirrored = false;     // seen from behind
  Homography cameraFromWall;
};

class FiducialCheck {
 public:
  FiducialCheck(std::span<const PointPair> pairs, std::span<const std::string> names, const CameraIntrinsics& camera)
      : pairs_(pairs.begin(), pairs.end()), names_(names), camera_(camera), all_(fit(pairs_)) {}

  std::optional<std::string> run() const {
    if (all_.misfit < kFits && all_.shape < kOutOfShape) return std::nullopt;
    if (auto text = exchanged()) return text;
    if (pairs_.size() > 4) {
      if (all_.misfit < kFits) return std::nullopt;  // all agree: rather the focal length is in doubt
      return mistyped();
    }
    return "the four fiducials (" + list() + ") cannot be a flat wall seen by this camera: " + shapeText() +
           "; check their places in wall.yaml: one is mistyped, or x and y are not in the same units";
  }

 private:
  [[nodiscard]] Fit fit(const Pairs& pairs) const {
    Pairs reversed;
    for (const auto& pair : pairs) reversed.push_back({pair.target, pair.source});
    Fit fit;
    try {
      fit.cameraFromWall = solveCollineation(reversed);
    } catch (const EstimateError&) {
      return fit;
    }
    // A fiducial beyond the horizon is behind the camera.
    const auto weight = [&](const PointPair& pair) { return fit.cameraFromWall.weight(pair.source); };
    const double first = weight(reversed.front());
    if (std::ranges::any_of(reversed, [&](const auto& pair) { return weight(pair) * first <= 0; })) return fit;
    fit.misfit = rmsError(fit.cameraFromWall, reversed);
    fit.shape = shapeOf(fit.cameraFromWall);
    fit.mirrored = mirrored(fit.cameraFromWall, reversed.front().source);
    return fit;
  }

  [[nodiscard]] static bool mirrored(const Homography& cameraFromWall, glm::dvec2 pointInWall) {
    const auto& h = cameraFromWall.rowMajor();
    const double determinant =
        h[0] * (h[4] * h[8] - h[5] * h[7]) - h[1] * (h[3] * h[8] - h[5] * h[6]) + h[2] * (h[3] * h[7] - h[4] * h[6]);
    return determinant * cameraFromWall.weight(pointInWall) < 0;
  }

  /// The wall's two axes in the camera's frame must be orthogonal and of one length.
  [[nodiscard]] double shapeOf(const Homography& cameraFromWall) const {
    const auto& h = cameraFromWall.rowMajor();
    const auto axis = [&](std::size_t i) {
      return glm::dvec3((h[i] - camera_.cx * h[6 + i]) / camera_.fx, (h[3 + i] - camera_.cy * h[6 + i]) / camera_.fy,
                        h[6 + i]);
    };
    const double x = glm::length(axis(0));
    const double y = glm::length(axis(1));
    return std::max(std::abs(x / y - 1), std::abs(glm::dot(axis(0), axis(1)) / (x * y)));
  }

  [[nodiscard]] bool explains(const Fit& other) const {
    return !other.mirrored && other.shape < kOutOfShape && other.misfit < std::max(kFits, all_.misfit / kMuchBetter) &&
           (all_.misfit > kMuchBetter * other.misfit || all_.shape > kMuchBetter * other.shape);
  }

  [[nodiscard]] std::optional<std::string> exchanged() const {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      for (std::size_t k = i + 1; k < pairs_.size(); ++k) {
        Pairs swapped = pairs_;
        std::swap(swapped[i].target, swapped[k].target);
        if (!explains(fit(swapped))) continue;
        return "the places of fiducials " + names_[i] + " " + place(pairs_[i].target) + " and " + names_[k] + " " +
               place(pairs_[k].target) + " seem to be exchanged: with these two the other way round all fit together";
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::string> mistyped() const {
    std::optional<std::size_t> worst;
    Fit best;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      Pairs others = pairs_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const Fit without = fit(others);
      if (!explains(without)) continue;
      // Any four fit a homography: then the one whose plane looks most like one.
      const bool better = others.size() > 4 ? without.misfit < best.misfit : without.shape < best.shape;
      if (worst && !better) continue;
      worst = i;
      best = without;
    }
    if (!worst) return std::nullopt;
    const glm::dvec2 seen = best.cameraFromWall.inverse().map(pairs_[*worst].source);
    return "fiducial " + names_[*worst] + " is measured as at: " + place(pairs_[*worst].target) +
           ", but is seen at about " + place(seen) + ": mistyped?";
  }

  [[nodiscard]] std::string shapeText() const {
    if (all_.shape >= kNoPlane) return "seen in this order their outline crosses itself";
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "it would be out of shape by %.0f %%", 100 * all_.shape);
    return text.data();
  }

  [[nodiscard]] std::string list() const {
    std::string text;
    for (const auto& name : names_) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  /// To a thousandth of what the fiducials span.
  [[nodiscard]] std::string place(glm::dvec2 point) const {
    double span = 0;
    for (const auto& pair : pairs_) span = std::max(span, glm::length(pair.target - pairs_.front().target));
    const int digits = std::clamp(3 - static_cast<int>(std::floor(std::log10(std::max(span, 1e-9)))), 0, 9);
    const auto number = [digits](double value) {
      std::array<char, 64> text{};
      std::snprintf(text.data(), text.size(), "%.*f", digits, value);
      return std::string(text.data());
    };
    return "[" + number(point.x) + ", " + number(point.y) + "]";
  }

  Pairs pairs_;
  std::span<const std::string> names_;
  const CameraIntrinsics& camera_;
  Fit all_;
};

}  // namespace

std::optional<std::string> explainFiducials(std::span<const PointPair> pairs, std::span<const std::string> names,
                                            const CameraIntrinsics& camera) {
  assert(pairs.size() == names.size());
  if (pairs.size() < 4) return std::nullopt;
  return FiducialCheck(pairs, names, camera).run();
}

}  // namespace pixelflex::calib
