#include "calib/simulate/light_image.h"

#include <array>
#include <cassert>
#include <cmath>

#include "calib/simulate/blur.h"
#include "calib/simulate/projector_light.h"

namespace pixelflex::calib {

namespace {

using devices::Image8;
using devices::ImageF;
using devices::Size;

int apronOf(const SimulatedProjectorSpec& projector) {
  return 3 + static_cast<int>(std::ceil(4 * projector.defocus));
}

Size withApron(Size size, int apron) {
  return {size.width + 2 * apron, size.height + 2 * apron};
}

using Table = std::array<std::array<float, 256>, 3>;

Table lightOfCodes(const Response& response, LightImage::Leak leaking) {
  Table table{};
  for (int channel = 0; channel < 3; ++channel) {
    const double leak = leaking == LightImage::Leak::kWith ? 0 : channelLight(response, channel, 0);
    for (std::size_t code = 0; code < 256; ++code) {
      const double light = channelLight(response, channel, static_cast<double>(code) / 255);
      table.at(static_cast<std::size_t>(channel)).at(code) = static_cast<float>(light - leak);
    }
  }
  return table;
}

}  // namespace

LightImage::LightImage(const SimulatedProjectorSpec& projector, const Image8& frame, Leak leak)
    : apron_(apronOf(projector)), light_(withApron(projector.resolution, apron_), kChannels) {
  assert(frame.size() == projector.resolution && (frame.channels() == 1 || frame.channels() == 3));
  const Table table = lightOfCodes(projector.response, leak);
  const auto step = static_cast<std::size_t>(frame.channels());
  const std::size_t green = step == 3 ? 1 : 0;
  for (int y = 0; y < frame.height(); ++y) {
    const std::uint8_t* code = frame.row(y).data();
    float* out = light_.row(y + apron_).data() + apron_ * kChannels;
    for (int x = 0; x < frame.width(); ++x, code += step, out += kChannels) {
      out[0] = table[0][code[0]];
      out[1] = table[1][code[green]];
      out[2] = table[2][code[2 * green]];
    }
  }
  defocus(projector.defocus);
}

LightImage::LightImage(const SimulatedProjectorSpec& projector)
    : apron_(apronOf(projector)), light_(withApron(projector.resolution, apron_), kChannels) {
  for (int y = 0; y < projector.resolution.height; ++y) {
    auto row = light_.row(y + apron_);
    for (int i = apron_ * kChannels; i < (apron_ + projector.resolution.width) * kChannels; ++i) {
      row[static_cast<std::size_t>(i)] = 1;
    }
  }
  defocus(projector.defocus);
}

void LightImage::defocus(double sigma) {
  // Linear interpolation spreads a sample with variance 1/6; a square pixel has 1/12 and the defocus sigma^2.
  blur(light_, gaussianKernel(sigma * sigma + 1.0 / 12 - 1.0 / 6));
}

}  // namespace pixelflex::calib
