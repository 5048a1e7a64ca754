#include "viewer/programs/control_taps.h"

#include "viewer/programs/modifier_keys.h"

namespace pixelflex::viewer {

bool ControlTaps::key(std::uint32_t keysym, bool pressed, Clock::time_point now) {
  constexpr std::chrono::milliseconds kTogether{600};
  constexpr int kStrokes = 4;
  const bool follows = strokes_ == 0 || (keysym == keysym_ && now - begin_ <= kTogether);
  if (!isControl(keysym) || !follows || pressed != (strokes_ % 2 == 0)) strokes_ = 0;
  if (strokes_ == 0) {
    if (!isControl(keysym) || !pressed) return false;
    keysym_ = keysym;
    begin_ = now;
  }
  if (++strokes_ < kStrokes) return false;
  strokes_ = 0;
  return true;
}

}  // namespace pixelflex::viewer
