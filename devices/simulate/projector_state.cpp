#include "devices/simulate/projector_state.h"

namespace pixelflex::devices {

void ProjectorState::setPower(bool on, Time now) {
  advance(now);
  if (on && (power == Power::kOff || power == Power::kCooling)) {
    power = Power::kWarming;
    powerChangesAt = now + warmUp;
  } else if (!on && (power == Power::kOn || power == Power::kWarming)) {
    power = Power::kCooling;
    powerChangesAt = now + coolDown;
  }
}

void ProjectorState::advance(Time now) {
  if (!isChanging() || now < powerChangesAt) return;
  power = power == Power::kWarming ? Power::kOn : Power::kOff;
}

}  // namespace pixelflex::devices
