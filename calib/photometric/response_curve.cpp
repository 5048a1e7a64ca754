#include "calib/photometric/response_curve.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "calib/photometric/monotone.h"
#include "calib/store/readings_file.h"

namespace pixelflex::calib {
namespace {

using Channel = std::array<double, 256>;

constexpr std::array<std::string_view, 3> kChannels = {"red", "green", "blue"};
constexpr std::size_t kThird = 256 / 3;

/// The first few problems, one a line.
std::string joined(const std::vector<Problem>& problems) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, problems.size()); ++i) {
    text += (i == 0 ? "" : "\n") + problems[i].text();
  }
  if (problems.size() > kShown) text += "\nand " + std::to_string(problems.size() - kShown) + " more";
  return text;
}

Channel withoutFalls(Channel light) {
  levelFalls(light);
  return light;
}

/// What one channel may be accused of.
class ChannelCheck {
 public:
  ChannelCheck(const Readings& readings, std::size_t channel, const std::string& file)
      : readings_(readings),
        read_(readings.light.at(channel)),
        levelled_(withoutFalls(read_)),
        range_(levelled_.back() - levelled_.front()),
        name_(kChannels.at(channel)),
        file_(file) {}

  /// The light without falls; throws ResponseError unless it can be a response.
  [[nodiscard]] Channel normalised() const {
    if (!(range_ > 0)) refuse("do not rise from value 0 to 255");
    checkFalls();
    checkEnds();
    Channel light = levelled_;
    for (double& value : light) value = (value - levelled_.front()) / range_;
    return light;
  }

 private:
  [[noreturn]] void refuse(const std::string& what, int line = 0) const {
    const std::string place = line > 0 ? file_ + ":" + std::to_string(line) : file_;
    throw ResponseError(place + ": the " + std::string(name_) + " readings " + what +
                        ": measure again, or remove the gamma key");
  }

  /// Noise of some per cent is levelled without a word; a reading further off is a mistake.
  void checkFalls() const {
    for (std::size_t code = 0; code < 256; ++code) {
      const double allowed = 0.005 * range_ + 0.06 * (levelled_.at(code) - levelled_.front());
      if (std::abs(read_.at(code) - levelled_.at(code)) > allowed) {
        refuse("fall, near value " + std::to_string(code) + ", by more than noise does", readings_.line.at(code));
      }
    }
  }

  void checkEnds() const {
    const auto risen = [&](double part) {
      const double level = levelled_.front() + part * range_;
      return static_cast<std::size_t>(std::ranges::upper_bound(levelled_, level) - levelled_.begin());
    };
    const std::size_t foot = risen(0.0002);
    const std::size_t shoulder = 256 - risen(0.998);
    if (foot > kThird)
      refuse("stay at black up to value " + std::to_string(foot - 1) + ", as below a meter's threshold");
    if (shoulder > kThird) refuse("are clipped from value " + std::to_string(256 - shoulder) + " on");
  }

  const Readings& readings_;
  const Channel& read_;
  Channel levelled_;
  double range_;
  std::string_view name_;
  const std::string& file_;
};

/// Standard deviation of the readings' noise, relative to light with a floor of 1 % of white. Third differences take
/// out all that is smooth; their median does not see kinks.
double relativeNoise(const Channel& light) {
  std::vector<double> differences;
  for (std::size_t i = 0; i + 3 < light.size(); ++i) {
    const double third = light.at(i + 3) - 3 * light.at(i + 2) + 3 * light.at(i + 1) - light.at(i);
    differences.push_back(std::abs(third) / (light.at(i) + 0.01));
  }
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::ranges::nth_element(differences, middle);
  return *middle / (0.6745 * std::sqrt(20.0));
}

/// The value at `code` of the parabola that fits its neighbours best.
double parabolaAt(const Channel& light, std::size_t code, std::size_t reach) {
  const std::size_t width = 2 * reach;  // the window keeps its width at the ends
  const std::size_t first = std::min(code - std::min(code, reach), light.size() - 1 - width);
  const std::size_t last = first + width;
  // Orthogonal polynomials over the window, by Gram and Schmidt.
  const double middle = 0.5 * static_cast<double>(first + last);
  const double count = static_cast<double>(last - first) + 1;
  const double square = (count * count - 1) / 12;  // mean of (x - middle)^2
  std::array<double, 3> sums{};
  std::array<double, 3> norms{};
  for (std::size_t i = first; i <= last; ++i) {
    const double x = static_cast<double>(i) - middle;
    const std::array<double, 3> basis = {1, x, x * x - square};
    for (std::size_t k = 0; k < 3; ++k) {
      sums.at(k) += basis.at(k) * light.at(i);
      norms.at(k) += basis.at(k) * basis.at(k);
    }
  }
  const double x = static_cast<double>(code) - middle;
  return sums[0] / norms[0] + sums[1] / norms[1] * x + sums[2] / norms[2] * (x * x - square);
}

Channel smoothed(const Channel& light) {
  const double noise = relativeNoise(light);
  if (noise < 0.001) return light;
  const auto reach = std::min<std::size_t>(20, 2 + static_cast<std::size_t>(1200 * noise));
  Channel smooth{};
  for (std::size_t code = 0; code < smooth.size(); ++code) smooth.at(code) = parabolaAt(light, code, reach);
  levelFalls(smooth);
  const double black = smooth.front();
  const double range = smooth.back() - black;
  for (double& value : smooth) value = (value - black) / range;
  return smooth;
}

}  // namespace

ResponseCurve parseReadings(std::string_view csv, const std::string& file) {
  const Readings readings = readReadings(csv, file);
  if (!readings.problems.empty()) throw ResponseError(joined(readings.problems));
  ResponseCurve curve;
  for (std::size_t c = 0; c < 3; ++c) curve.light.at(c) = ChannelCheck(readings, c, file).normalised();
  return curve;
}

std::string formatReadings(const ResponseCurve& curve) {
  std::string text = "value,red,green,blue\n";
  for (std::size_t code = 0; code < 256; ++code) {
    text += std::to_string(code);
    for (const auto& light : curve.light) {
      std::array<char, 32> number{};
      const auto end = std::to_chars(number.data(), number.data() + number.size(), light.at(code)).ptr;
      text += ',';
      text.append(number.data(), end);
    }
    text += '\n';
  }
  return text;
}

ResponseCurve withoutNoise(const ResponseCurve& curve) {
  ResponseCurve smooth;
  std::ranges::transform(curve.light, smooth.light.begin(), smoothed);
  return smooth;
}

std::vector<float> inverseResponse(const std::array<double, 256>& light) {
  std::vector<float> codes(kInverseEntries);
  for (std::size_t i = 0; i < kInverseEntries; ++i) {
    const double wanted = std::pow(double(i) / (kInverseEntries - 1), 2.2);
    // The last code whose light does not exceed the light wanted, then linearly towards the next.
    const auto above = std::ranges::upper_bound(light, wanted);
    if (above == light.end()) {
      codes[i] = 1;
      continue;
    }
    const auto upper = static_cast<std::size_t>(above - light.begin());
    const double low = light[upper - 1];
    codes[i] = static_cast<float>((double(upper - 1) + (wanted - low) / (light[upper] - low)) / 255);
  }
  codes.front() = 0;  // black is code 0, whatever the foot
  return codes;
}

}  // namespace pixelflex::calib
