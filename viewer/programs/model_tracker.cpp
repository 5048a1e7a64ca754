#include "viewer/programs/model_tracker.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <sstream>

namespace pixelflex::viewer {
namespace {

std::optional<glm::dvec3> placeIn(const std::string& line) {
  std::istringstream words(line);
  glm::dvec3 place;
  if (!(words >> place.x >> place.y >> place.z)) return std::nullopt;
  const bool before = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z) && place.z > 0;
  return before ? std::optional(place) : std::nullopt;
}

}  // namespace

std::optional<glm::dvec3> ModelTracker::read() {
  std::optional<glm::dvec3> last;
  constexpr std::size_t kLongestLine = 4096;
  pollfd ready{descriptor_, POLLIN, 0};
  while (!ended_ && ::poll(&ready, 1, 0) > 0) {
    std::array<char, kLongestLine> bytes{};
    const auto count = ::read(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) break;
    ended_ = count <= 0;
    if (ended_) break;
    rest_.append(bytes.data(), static_cast<std::size_t>(count));
    for (auto end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
      if (const auto place = placeIn(rest_.substr(0, end))) last = place;
      rest_.erase(0, end + 1);
    }
    if (rest_.size() > kLongestLine) rest_.clear();
  }
  return last;
}

}  // namespace pixelflex::viewer
