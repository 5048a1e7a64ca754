#include "viewer/programs/pointer_shake.h"

#include <cmath>
#include <cstddef>

namespace pixelflex::viewer {

bool PointerShake::move(glm::dvec2 position, Clock::time_point now) {
  const bool across = across_.move(position.x, now);
  const bool along = along_.move(position.y, now);
  if (across || along) forget();
  return across || along;
}

bool PointerShake::Axis::move(double position, Clock::time_point now) {
  constexpr double kStroke = 80;  // shorter ones are those of a hand that aims
  constexpr std::size_t kTurns = 4;
  constexpr std::chrono::milliseconds kTogether{900};
  if (!begun) farthest = position;
  begun = true;
  const double further = position - farthest;
  const int way = further > 0 ? 1 : -1;
  const bool turned = way != direction && std::abs(further) >= kStroke;
  if (!turned && way != direction) return false;
  farthest = position;
  if (!turned) return false;
  if (direction != 0) turns.push_back(now);
  direction = way;
  while (!turns.empty() && now - turns.front() > kTogether) turns.pop_front();
  return turns.size() >= kTurns;
}

}  // namespace pixelflex::viewer
