#include "calib/photometric/response_curve.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace pixelflex::calib {
namespace {

using Row = std::array<double, 4>;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<Row> parseRow(std::string_view line) {
  Row row{};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto comma = line.find(',');
    if ((comma == std::string_view::npos) != (i == 3)) return std::nullopt;
    const auto cell = trimmed(line.substr(0, comma));
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), row[i]);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(row[i])) return std::nullopt;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return row;
}

std::string where(const std::string& file, int line) {
  return file + ":" + std::to_string(line) + ": ";
}

/// Pool adjacent violators: the closest non-falling curve in the least-squares sense.
void levelFalls(std::array<double, 256>& values) {
  std::vector<std::pair<double, int>> pools;  // mean, count
  for (const double value : values) {
    pools.emplace_back(value, 1);
    while (pools.size() > 1 && pools[pools.size() - 2].first > pools.back().first) {
      const auto [mean, count] = pools.back();
      pools.pop_back();
      auto& [poolMean, poolCount] = pools.back();
      poolMean = (poolMean * poolCount + mean * count) / (poolCount + count);
      poolCount += count;
    }
  }
  std::size_t i = 0;
  for (const auto& [mean, count] : pools) {
    for (int k = 0; k < count; ++k) values[i++] = mean;
  }
}

void normalise(std::array<double, 256>& light, const std::string& file, const char* channel) {
  levelFalls(light);
  const double black = light.front();
  const double range = light.back() - black;
  if (!(range > 0)) {
    throw ResponseError(file + ": the " + channel +
                        " readings do not rise from value 0 to 255: measure again, or remove the gamma key");
  }
  for (double& value : light) value = (value - black) / range;
}

}  // namespace

ResponseCurve parseReadings(std::string_view csv, const std::string& file) {
  ResponseCurve curve;
  int line = 0;
  std::size_t expected = 0;
  while (!csv.empty()) {
    const auto end = csv.find('\n');
    const auto text = trimmed(csv.substr(0, end));
    csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
    ++line;
    if (text.empty() || text.front() == '#') continue;
    const auto row = parseRow(text);
    if (!row && expected == 0 && line == 1) continue;  // a header
    if (!row) throw ResponseError(where(file, line) + "expected four numbers: value,red,green,blue");
    if (expected > 255 || (*row)[0] != static_cast<double>(expected)) {
      throw ResponseError(where(file, line) + "expected the values 0 to 255 in order, one row each");
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if ((*row)[c + 1] < 0) throw ResponseError(where(file, line) + "a reading is negative");
      curve.light[c][expected] = (*row)[c + 1];
    }
    ++expected;
  }
  if (expected != 256) {
    throw ResponseError(file + ": expected 256 rows value,red,green,blue; found " + std::to_string(expected));
  }
  constexpr std::array kChannels = {"red", "green", "blue"};
  for (std::size_t c = 0; c < 3; ++c) normalise(curve.light[c], file, kChannels[c]);
  return curve;
}

std::string formatReadings(const ResponseCurve& curve) {
  std::string text = "value,red,green,blue\n";
  for (std::size_t code = 0; code < 256; ++code) {
    text += std::to_string(code);
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<char, 32> number{};
      const auto end = std::to_chars(number.data(), number.data() + number.size(), curve.light[c][code]).ptr;
      text += ',';
      text.append(number.data(), end);
    }
    text += '\n';
  }
  return text;
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
