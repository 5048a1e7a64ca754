#include "calib/store/spelling.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace pixelflex::calib {
namespace {

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearestWord(std::string_view typed, const std::set<std::string>& known) {
  constexpr std::size_t kLongest = 64;  // of a word anybody means
  if (typed.size() > kLongest) return {};
  std::string best;
  std::size_t bestDistance = std::max<std::size_t>(2, typed.size() / 3) + 1;
  for (const auto& candidate : known) {
    const std::size_t distance = editDistance(typed, candidate);
    if (distance >= bestDistance || distance >= candidate.size()) continue;
    best = candidate;
    bestDistance = distance;
  }
  return best;
}

}  // namespace pixelflex::calib
