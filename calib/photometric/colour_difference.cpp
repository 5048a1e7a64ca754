#include "calib/photometric/colour_difference.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <numbers>

namespace pixelflex::calib {
namespace {

using std::numbers::pi;

double radians(double degrees) {
  return degrees * pi / 180;
}

/// The cube root of CIE 1976 with its straight foot.
double lightnessOf(double part) {
  constexpr double kFoot = 6.0 / 29;
  const double light = std::max(part, 0.0);
  return light > kFoot * kFoot * kFoot ? std::cbrt(light) : light / (3 * kFoot * kFoot) + 4.0 / 29;
}

/// C^7 / (C^7 + 25^7) under a root: near one for strong colours.
double strength(double chroma) {
  const double seventh = std::pow(chroma, 7);
  return std::sqrt(seventh / (seventh + std::pow(25.0, 7)));
}

struct Polar {
  double chroma = 0, hue = 0;  // hue in radians, 0 to two pi
};

Polar polarOf(double a, double b) {
  const double hue = std::atan2(b, a);
  return {std::hypot(a, b), hue < 0 ? hue + 2 * pi : hue};
}

/// Opposite hues differ by half a turn however they were rounded; neither way round is the shorter.
constexpr double kHalfTurn = pi + 1e-9;

double hueStep(const Polar& from, const Polar& to) {
  if (from.chroma * to.chroma == 0) return 0;
  const double step = to.hue - from.hue;
  if (step > kHalfTurn) return step - 2 * pi;
  return step < -kHalfTurn ? step + 2 * pi : step;
}

double meanHue(const Polar& first, const Polar& second) {
  const double sum = first.hue + second.hue;
  if (first.chroma * second.chroma == 0) return sum;
  if (std::abs(first.hue - second.hue) <= kHalfTurn) return sum / 2;
  return sum < 2 * pi ? sum / 2 + pi : sum / 2 - pi;
}

/// How much less a step of hue is seen at some hues.
double hueWeight(double hue) {
  return 1 - 0.17 * std::cos(hue - radians(30)) + 0.24 * std::cos(2 * hue) + 0.32 * std::cos(3 * hue + radians(6)) -
         0.20 * std::cos(4 * hue - radians(63));
}

/// Blues: there steps of chroma and hue are not seen apart.
double rotation(double hue, double chroma) {
  const double turns = (hue - radians(275)) / radians(25);
  return -std::sin(2 * radians(30) * std::exp(-turns * turns)) * 2 * strength(chroma);
}

}  // namespace

Lab labFromXyz(glm::dvec3 xyz, glm::dvec3 white) {
  const double x = lightnessOf(xyz.x / white.x);
  const double y = lightnessOf(xyz.y / white.y);
  const double z = lightnessOf(xyz.z / white.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Lab labFromLinearSrgb(glm::dvec3 light) {
  // IEC 61966-2-1; columns are the XYZ of full red, green and blue.
  constexpr glm::dmat3 kXyzFromSrgb(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722, 0.9505);
  return labFromXyz(kXyzFromSrgb * light, kXyzFromSrgb * glm::dvec3(1, 1, 1));
}

double deltaE2000(const Lab& first, const Lab& second) {
  const double stretch = 1.5 - 0.5 * strength((std::hypot(first.a, first.b) + std::hypot(second.a, second.b)) / 2);
  const Polar one = polarOf(stretch * first.a, first.b);
  const Polar two = polarOf(stretch * second.a, second.b);
  const double chroma = (one.chroma + two.chroma) / 2;
  const double hue = meanHue(one, two);
  const double fromMiddle = std::pow((first.lightness + second.lightness) / 2 - 50, 2);

  const double lightnessPart =
      (second.lightness - first.lightness) / (1 + 0.015 * fromMiddle / std::sqrt(20 + fromMiddle));
  const double chromaPart = (two.chroma - one.chroma) / (1 + 0.045 * chroma);
  const double huePart =
      2 * std::sqrt(one.chroma * two.chroma) * std::sin(hueStep(one, two) / 2) / (1 + 0.015 * chroma * hueWeight(hue));
  const double squared = lightnessPart * lightnessPart + chromaPart * chromaPart + huePart * huePart +
                         rotation(hue, chroma) * chromaPart * huePart;
  return std::sqrt(std::max(squared, 0.0));
}

}  // namespace pixelflex::calib
