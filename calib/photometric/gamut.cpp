#include "calib/photometric/gamut.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <string>

#include "calib/photometric/light_error.h"

namespace pixelflex::calib {
namespace {

/// Photographs of primaries that differ more than this were mixed up.
constexpr double kLargestDesaturation = 0.5;

glm::dmat3 fromRows(const Matrix3& m) {
  return glm::transpose(glm::dmat3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]));
}

Matrix3 rowsOf(const glm::dmat3& m) {
  Matrix3 rows{};
  for (glm::length_t i = 0; i < 9; ++i) rows.at(static_cast<std::size_t>(i)) = m[i % 3][i / 3];
  return rows;
}

const glm::dvec3 kWhite(1, 1, 1);

/// The volume that three colours span, next to that of three at right angles.
double spread(const glm::dmat3& colours) {
  return std::abs(glm::determinant(colours)) /
         (glm::length(colours[0]) * glm::length(colours[1]) * glm::length(colours[2]));
}

constexpr double kLeastSpread = 0.02;

/// A projector's primaries for a white of luminance 1.
struct Primaries {
  glm::dmat3 colours;
  glm::dmat3 lightFromColour;
  double luminance;  // of its own white
};

std::string named(std::size_t projector) {
  return "projector " + std::to_string(projector + 1);
}

Primaries normalised(const Matrix3& measured, glm::dvec3 weights, std::size_t projector) {
  const glm::dmat3 colours = fromRows(measured);
  const double luminance = glm::dot(weights, colours * kWhite);
  bool plausible = std::isfinite(luminance) && luminance > 0;
  for (glm::length_t i = 0; i < 3; ++i) plausible = plausible && glm::dot(weights, colours[i]) > 0;
  if (!plausible || !(spread(colours) > kLeastSpread)) {
    throw LightError("the full red, green and blue of " + named(projector) +
                     " are black or look alike to the camera: photograph its colour fields again");
  }
  return {colours / luminance, glm::inverse(colours / luminance), luminance};
}

/// How far `colour` must be drawn towards `white` (same luminance) until the projector makes it.
double desaturationFor(const Primaries& projector, glm::dvec3 colour, glm::dvec3 white) {
  const glm::dvec3 from = projector.lightFromColour * colour;
  const glm::dvec3 to = projector.lightFromColour * white;
  double part = 0;
  for (glm::length_t i = 0; i < 3; ++i) {
    if (from[i] < 0) part = std::max(part, from[i] / (from[i] - to[i]));
  }
  return part;
}

/// The common primaries, their sum at `white`.
glm::dmat3 commonPrimaries(const std::vector<Primaries>& projectors, glm::dvec3 white, glm::dvec3 weights,
                           double& desaturation) {
  glm::dmat3 common(0);
  for (const auto& one : projectors) common += one.colours / static_cast<double>(projectors.size());
  for (glm::length_t i = 0; i < 3; ++i) {
    const glm::dvec3 grey = white * glm::dot(weights, common[i]);
    double part = 0;
    for (const auto& one : projectors) part = std::max(part, desaturationFor(one, common[i], grey));
    common[i] = common[i] * (1 - part) + grey * part;
    desaturation = std::max(desaturation, part);
  }
  // Red of one and blue of another average to a purple that both can make.
  if (desaturation > kLargestDesaturation || !(spread(common) > kLeastSpread)) {
    throw LightError(
        "the projectors' colours have too little in common: check that the photographs of red, green and blue fields "
        "are not mixed up, or switch colour matching off");
  }
  const glm::dvec3 amounts = glm::inverse(common) * white;
  for (glm::length_t i = 0; i < 3; ++i) common[i] *= amounts[i];
  return common;
}

ColourMatch matchOf(const Primaries& projector, const glm::dmat3& target, glm::dvec3 white) {
  const glm::dvec3 needed = projector.lightFromColour * white;
  const double kept = 1 / std::max({needed.x, needed.y, needed.z});
  ColourMatch match{
      .colour = rowsOf(projector.lightFromColour * target * kept), .scale = kept * projector.luminance, .kept = kept};
  for (double& value : match.colour) value = std::max(0.0, value);  // rounding
  return match;
}

}  // namespace

CommonGamut commonGamut(std::span<const Matrix3> primaries, const std::array<double, 3>& luminance) {
  assert(!primaries.empty());
  const glm::dvec3 weights(luminance[0], luminance[1], luminance[2]);
  std::vector<Primaries> projectors;
  glm::dvec3 white(0);
  for (std::size_t i = 0; i < primaries.size(); ++i) {
    projectors.push_back(normalised(primaries[i], weights, i));
    white += projectors.back().colours * kWhite / static_cast<double>(primaries.size());
  }
  for (std::size_t i = 0; i < projectors.size(); ++i) {
    const glm::dvec3 needed = projectors[i].lightFromColour * white;
    if (std::min({needed.x, needed.y, needed.z}) > 0) continue;
    throw LightError("the common white is out of reach of " + named(i) +
                     ": check its photographs of red, green and blue fields, or switch colour matching off");
  }
  CommonGamut gamut;
  const glm::dmat3 target = commonPrimaries(projectors, white, weights, gamut.desaturation);
  gamut.target = rowsOf(target);
  for (const auto& one : projectors) gamut.projectors.push_back(matchOf(one, target, white));
  return gamut;
}

}  // namespace pixelflex::calib
