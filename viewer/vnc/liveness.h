#pragma once

#include <chrono>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// Tells a server that has nothing to say from one that is gone: one that has been silent for a while is asked for a
/// sign of life, and one that does not give it is given up. No thread and no clock of its own.
class Liveness {
 public:
  /// Given up after `patience` without a byte, asked when rather less than half of that is over.
  Liveness(std::chrono::milliseconds patience, Deadline now) : patience_(patience), heard_(now) {}

  /// Something came from the server.
  void heard(Deadline now);
  enum class Verdict { kWait, kAsk, kGone };
  /// kAsk only once in a silence.
  [[nodiscard]] Verdict judge(Deadline now);
  /// When judge() will say something new.
  [[nodiscard]] Deadline due() const;
  [[nodiscard]] std::chrono::milliseconds patience() const { return patience_; }

 private:
  [[nodiscard]] Deadline askAt() const { return heard_ + patience_ * 4 / 9; }

  std::chrono::milliseconds patience_;
  Deadline heard_;
  bool asked_ = false;
};

}  // namespace pixelflex::viewer
