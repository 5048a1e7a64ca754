#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "devices/control/device.h"
#include "devices/transport/line_address.h"

namespace pixelflex::devices {

class LineLoop;

/// Hitachi's two-byte protocol of 1998 to 2001: CP-X955 and family, Proxima DP6850. 9600 8N1 unless its menu says else.
/// Zoom and focus cannot be read. POWER answers when the lamp is lit: up to 150 s.
[[nodiscard]] std::unique_ptr<Device> makeHitachiLegacy(LineLoop& loop, const LineAddress& address,
                                                        const std::string& name);

/// "BE EF" frames: Hitachi, Maxell, Christie LX and LW from 2001 on. 19200 8N1, or TCP port 23,
/// or TCP port 9715, where `password` is used if the projector asks for one.
[[nodiscard]] std::unique_ptr<Device> makeHitachiBeef(LineLoop& loop, const LineAddress& address,
                                                      const std::string& name, const std::string& password = {});

/// Epson's ESC/VP21. 9600 8N1, or TCP port 3629.
[[nodiscard]] std::unique_ptr<Device> makeEscVp21(LineLoop& loop, const LineAddress& address, const std::string& name);

/// InFocus and Proxima with commands such as (PWR1). 19200 8N1, or TCP port 23. `gap` is what the device needs between
/// two commands.
[[nodiscard]] std::unique_ptr<Device> makeInfocus(LineLoop& loop, const LineAddress& address, const std::string& name,
                                                  std::chrono::milliseconds gap = std::chrono::seconds(3));

/// PJLink of class 1 and 2, TCP port 4352. `password` may be empty.
[[nodiscard]] std::unique_ptr<Device> makePjlink(LineLoop& loop, const LineAddress& address, const std::string& name,
                                                 const std::string& password);

}  // namespace pixelflex::devices
