#pragma once

#include <string>

#include "viewer/vnc/rfb_log.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {

/// Turns libvncclient's last words into an error for people.
[[nodiscard]] SessionError streamFailure(const std::string& where, bool insideUpdate, const RfbLog& log);

/// Whatever came instead of a VNC server's greeting.
[[nodiscard]] SessionError notVnc(const std::string& where, const std::string& greeting);

}  // namespace pixelflex::viewer
