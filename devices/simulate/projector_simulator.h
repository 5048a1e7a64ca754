#pragma once

#include <memory>
#include <string>

#include "devices/simulate/projector_state.h"
#include "devices/simulate/simulated_device.h"

namespace pixelflex::devices {

/// A simulated projector of any protocol: bytes outside, ProjectorState inside.
class ProjectorSimulator : public SimulatedDevice {
 public:
  void advance(Time now) override { state_.advance(now); }
  [[nodiscard]] ProjectorState& state() { return state_; }

 private:
  ProjectorState state_;
};

/// Hitachi's two-byte protocol of 1998 to 2001 (CP-X955 and family).
[[nodiscard]] std::unique_ptr<ProjectorSimulator> makeHitachiLegacySimulator();
struct HitachiBeefSimulatorOptions {
  bool network = false;       // wrapped, as at TCP port 9715
  std::string password = {};  // there; empty: without authentication
};
/// Hitachi's and Christie's "BE EF" frames.
[[nodiscard]] std::unique_ptr<ProjectorSimulator> makeHitachiBeefSimulator(const HitachiBeefSimulatorOptions& options);
/// Epson's ESC/VP21, with the ESC/VP.net greeting where a client begins with it.
[[nodiscard]] std::unique_ptr<ProjectorSimulator> makeEscVp21Simulator();
/// InFocus' and Proxima's "(PWR1)".
[[nodiscard]] std::unique_ptr<ProjectorSimulator> makeInfocusSimulator();

struct PjlinkSimulatorOptions {
  int pjlinkClass = 2;
  std::string password = {};  // empty: without authentication
  bool sha256 = true;         // knows the authentication of version 2.10 as well
};
[[nodiscard]] std::unique_ptr<ProjectorSimulator> makePjlinkSimulator(const PjlinkSimulatorOptions& options);

}  // namespace pixelflex::devices
