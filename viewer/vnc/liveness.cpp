#include "viewer/vnc/liveness.h"

#include <algorithm>

namespace pixelflex::viewer {

void Liveness::heard(Deadline now) {
  heard_ = now;
  asked_ = false;
}

Liveness::Verdict Liveness::judge(Deadline now) {
  if (now < due()) return Verdict::kWait;
  if (asked_) return Verdict::kGone;
  asked_ = true;
  // A process that was stopped itself, or had no processor, gives the server the time to answer all the same.
  heard_ = std::max(heard_, now - patience_ * 4 / 9);
  return Verdict::kAsk;
}

Deadline Liveness::due() const {
  return asked_ ? heard_ + patience_ : askAt();
}

}  // namespace pixelflex::viewer
