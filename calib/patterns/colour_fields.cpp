#include "calib/patterns/colour_fields.h"

#include <string>

namespace pixelflex::calib {
namespace {

devices::Image8 fullField(devices::Size size, std::size_t channel) {
  devices::Image8 field(size, 3);
  for (std::size_t i = channel; i < field.samples().size(); i += 3) field.samples()[i] = 255;
  return field;
}

ProjectedPattern fieldOf(const std::string& name, devices::Size size, std::size_t channel) {
  return {name, "full " + name, [size, channel] { return fullField(size, channel); }};
}

}  // namespace

std::array<ProjectedPattern, 3> colourFields(devices::Size resolution) {
  return {fieldOf("red", resolution, 0), fieldOf("green", resolution, 1), fieldOf("blue", resolution, 2)};
}

}  // namespace pixelflex::calib
