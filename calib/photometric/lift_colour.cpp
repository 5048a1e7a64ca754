#include "calib/photometric/lift_colour.h"

#include <algorithm>
#include <cassert>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pixelflex::calib {
namespace {

constexpr double kBrightest = 0.9;    // of the target: black that is nearly there has the target's colour
constexpr double kStrongest = 2;      // of a channel: where hardly anything is missing its colour means little
constexpr double kWorthwhile = 1e-4;  // of the target: lifts below have no colour

glm::dmat3 matrixOf(const Matrix3& m) {
  return glm::transpose(glm::dmat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]));
}

class LiftColours {
 public:
  LiftColours(std::span<const Matrix3> primaries, std::span<const ProjectorLightMaps> projectors,
              const BlackTarget& black, const std::array<double, 3>& luminance)
      : projectors_(projectors), target_(black.target.samples()), weights_(luminance[0], luminance[1], luminance[2]) {
    for (const auto& matrix : primaries) {
      const auto& made = primaries_.emplace_back(matrixOf(matrix));
      const glm::dvec3 white = made * glm::dvec3(1);
      whites_.push_back(white / glm::dot(weights_, white));
    }
    common_ = commonColour();
  }

  [[nodiscard]] std::array<double, 3> of(std::size_t projector) const {
    glm::dvec3 missing(0);
    double wanted = 0;
    const auto& share = projectors_[projector].share.samples();
    for (std::size_t i = 0; i < target_.size(); ++i) {
      if (!(share[i] > 0)) continue;
      missing += double{share[i]} * (double{target_[i]} * common_ - leakAt(i));
      wanted += share[i] * target_[i];
    }
    const double luminance = glm::dot(weights_, missing);
    if (luminance <= kWorthwhile * wanted) return {1, 1, 1};
    const glm::dvec3 white = primaries_[projector] * glm::dvec3(1);
    const glm::dvec3 colour = missing * (glm::dot(weights_, white) / luminance);
    const glm::dvec3 own = glm::clamp(glm::inverse(primaries_[projector]) * colour, 0.0, kStrongest);
    return {own.x, own.y, own.z};
  }

 private:
  /// The colour of what leaks at a place of the raster.
  [[nodiscard]] glm::dvec3 leakAt(std::size_t i) const {
    glm::dvec3 leak(0);
    for (std::size_t k = 0; k < projectors_.size(); ++k) {
      leak += double{projectors_[k].black.samples()[i]} * whites_[k];
    }
    return leak;
  }

  /// Of luminance 1: that of black where nothing is missing.
  [[nodiscard]] glm::dvec3 commonColour() const {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < target_.size(); ++i) {
      const glm::dvec3 leak = leakAt(i);
      if (glm::dot(weights_, leak) > kBrightest * target_[i]) sum += leak;
    }
    return sum / glm::dot(weights_, sum);
  }

  std::span<const ProjectorLightMaps> projectors_;
  std::span<const float> target_;
  glm::dvec3 weights_;
  std::vector<glm::dmat3> primaries_;
  std::vector<glm::dvec3> whites_;  // of luminance 1
  glm::dvec3 common_{0};
};

}  // namespace

std::vector<std::array<double, 3>> liftColours(std::span<const Matrix3> primaries,
                                               std::span<const ProjectorLightMaps> projectors, const BlackTarget& black,
                                               const std::array<double, 3>& luminance) {
  assert(primaries.size() == projectors.size());
  const LiftColours colours(primaries, projectors, black, luminance);
  std::vector<std::array<double, 3>> all;
  for (std::size_t i = 0; i < projectors.size(); ++i) all.push_back(colours.of(i));
  return all;
}

}  // namespace pixelflex::calib
