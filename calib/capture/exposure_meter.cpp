#include "calib/capture/exposure_meter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>

#include "calib/capture/photographs.h"

namespace pixelflex::calib {
namespace {

constexpr int kWanted = 217;     // 85 % of the scale
constexpr int kBrightest = 233;  // above it single pixels may be clipped
constexpr int kDarkest = 190;
constexpr int kClipped = 250;  // says nothing about by how much
constexpr int kTries = 12;
constexpr double kSame = 0.99;   // of an exposure: what it is set to may differ by the camera's rounding
constexpr double kLower = 0.85;  // less than a third of a stop, by which the exposures of still cameras differ

devices::Image8 whiteOf(devices::Size size) {
  devices::Image8 white(size, 1);
  std::ranges::fill(white.samples(), std::uint8_t{255});
  return white;
}

}  // namespace

int peakOf(const devices::Image8& photo) {
  std::array<std::int64_t, 256> counts{};
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      const std::uint8_t* pixel = &photo.at(x, y);
      ++counts.at(*std::max_element(pixel, pixel + photo.channels()));
    }
  }
  std::int64_t above = photo.size().area() / 2000;
  int code = 255;
  for (; code > 0 && above >= counts.at(static_cast<std::size_t>(code)); --code) {
    above -= counts.at(static_cast<std::size_t>(code));
  }
  return code;
}

MeteredPerson::MeteredPerson(devices::Operator& person, devices::Camera& camera,
                             std::vector<devices::Projector*> projectors, std::string name)
    : person_(person), camera_(camera), projectors_(std::move(projectors)), name_(std::move(name)) {}

bool MeteredPerson::arrange(devices::Scene scene, int index) {
  if (!person_.arrange(scene, index)) return false;
  auto* control = camera_.exposureControl();
  if (control == nullptr) return true;
  if (scene == devices::Scene::kDark) {
    if (!dark_) dark_ = meterDark();
    control->setExposure(*dark_);
  } else {
    if (!lit_) lit_ = suitable(control->exposure());
    control->setExposure(*lit_);
  }
  return true;
}

/// An exposure that no projector's white is too bright for, and the brightest is bright enough.
double MeteredPerson::meterDark() {
  auto& control = *camera_.exposureControl();
  std::optional<double> seconds;
  for (devices::Projector* projector : projectors_) {
    projector->show(whiteOf(projector->resolution()));
    if (seconds) control.setExposure(*seconds);
    if (!seconds || peakOf(camera_.shoot()) > kBrightest) seconds = suitable(control.exposure());
    projector->blank();
  }
  return seconds.value_or(control.exposure());
}

/// For what is before the camera now.
double MeteredPerson::suitable(double start) {
  auto& control = *camera_.exposureControl();
  const auto range = control.exposureRange();
  double seconds = control.setExposure(start);
  double tooBright = std::numeric_limits<double>::infinity();  // the shortest that is
  for (int i = 0; i < kTries; ++i) {
    const int peak = peakOf(camera_.shoot());
    if (peak >= kDarkest && peak <= kBrightest) return seconds;
    const double factor = peak >= kClipped ? 0.25 : std::min(8.0, double{kWanted} / std::max(peak, 1));
    if (peak > kBrightest) tooBright = std::min(tooBright, seconds);
    const double before = seconds;
    double next = std::clamp(seconds * factor, range.shortest, range.longest);
    seconds = control.setExposure(next);
    // Exposures may come in steps, and the nearest be one that is known.
    while (seconds > kSame * tooBright && next > range.shortest) {
      next = std::max(kLower * next, range.shortest);
      seconds = control.setExposure(next);
    }
    if (seconds > kSame * tooBright) {
      throw CaptureError(name_ + ": over-exposed even at its shortest exposure, " + std::to_string(seconds) +
                         " s: close its aperture, lower its gain, or put a grey filter before it");
    }
    // Darker than wanted; what that means is for those who look at photographs.
    if (seconds >= kSame * before && kSame * seconds <= before) return seconds;
  }
  throw CaptureError(name_ +
                     ": no exposure suits: the light changes from one photograph to the next. Switch off what "
                     "flickers, and everything automatic in the camera");
}

}  // namespace pixelflex::calib
