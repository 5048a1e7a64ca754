#include "tests/accuracy/seen_wall.h"

namespace pixelflex::calib {

const devices::ImageF& SeenWall::seen(const Colour& colour) {
  auto found = seen_.find(colour);
  if (found == seen_.end()) found = seen_.emplace(colour, view_.seen(frames(colour))).first;
  return found->second;
}

const std::vector<devices::Image8>& SeenWall::frames(const Colour& colour) {
  auto found = frames_.find(colour);
  if (found == frames_.end()) found = frames_.emplace(colour, show_(plainDesktop(size_, colour))).first;
  return found->second;
}

devices::Image8 plainDesktop(devices::Size size, const Colour& colour) {
  devices::Image8 desktop(size, 4);
  const std::array<int, 4> pixel{colour[0], colour[1], colour[2], 255};
  auto samples = desktop.samples();
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint8_t>(pixel.at(i % 4));
  return desktop;
}

}  // namespace pixelflex::calib
