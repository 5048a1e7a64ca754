#pragma once

#include <span>

#include "viewer/vnc/handshake_stream.h"
#include "viewer/vnc/security_types.h"
#include "viewer/vnc/session.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {

/// The best security type among those offered. Throws SessionError (kUntrusted) when none is good enough.
[[nodiscard]] const SecurityType& chooseOrRefuse(std::span<const std::uint32_t> offered, const std::string& where,
                                                 const SessionOptions& options);

/// VeNCrypt after it was chosen: agrees on a sub-type, and encrypts if that is part of it. Throws SessionError.
[[nodiscard]] const SecurityType& agreeOnVenCrypt(HandshakeStream& server, const SessionOptions& options);

/// Sends what `type` asks for. Throws SessionError (kPasswordNeeded) when that was not given.
void logIn(HandshakeStream& server, const SecurityType& type, const SessionOptions& options);

/// The server's answer to it; `givesReason`: one follows a refusal. Throws SessionError (kAuthentication).
void readLoginResult(HandshakeStream& server, const SecurityType& type, bool givesReason);

/// Reads why the server will not have us; an error for people.
[[nodiscard]] SessionError readRefusal(HandshakeStream& server, bool afterLogin);

}  // namespace pixelflex::viewer
