#include "viewer/vnc/login.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/text_encoding.h"
#include "viewer/vnc/vnc_auth.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kMaxReasonBytes = 1024;

// Numeric addresses are no names.
std::string serverName(const ServerAddress& server) {
  const bool numeric =
      server.host.find(':') != std::string::npos || server.host.find_first_not_of("0123456789.") == std::string::npos;
  return numeric ? std::string{} : server.host;
}

[[noreturn]] void refusePassword(const std::string& where, const std::string& what, const std::string& how) {
  throw SessionError(CloseKind::kPasswordNeeded, where + " asks for " + what + ": give " + how);
}

const Secret& passwordFor(const std::string& where, const SessionOptions& options) {
  if (!options.password || options.password->empty()) {
    refusePassword(where, "a password", "it with --password-file or PIXELFLEX_VNC_PASSWORD");
  }
  return *options.password;
}

void sendPlainLogin(HandshakeStream& server, const SessionOptions& options) {
  const Secret& password = passwordFor(server.where(), options);
  std::vector<std::uint8_t> message;
  message.reserve(8 + options.user.size() + password.size());  // one that grows leaves copies behind
  appendNumber(message, static_cast<std::uint32_t>(options.user.size()), 4);
  appendNumber(message, static_cast<std::uint32_t>(password.size()), 4);
  message.insert(message.end(), options.user.begin(), options.user.end());
  message.insert(message.end(), password.text().begin(), password.text().end());
  try {
    server.write(message);
  } catch (...) {
    wipe(message);
    throw;
  }
  wipe(message);
}

void answerChallenge(HandshakeStream& server, const SessionOptions& options) {
  const Secret& password = passwordFor(server.where(), options);
  const std::vector<std::uint8_t> challenge = server.read(16);
  server.write(answerVncChallenge(std::span<const std::uint8_t, 16>(challenge), password.text()));
}

std::vector<std::uint32_t> readSubTypes(HandshakeStream& server) {
  (void)server.read(2);  // the highest version it knows; there is none after 0.2
  constexpr std::array<std::uint8_t, 2> kVersion{0, 2};
  server.write(kVersion);
  if (server.readNumber(1) != 0) {
    throw SessionError(CloseKind::kUntrusted, server.where() + " does not know version 0.2 of VeNCrypt: update it");
  }
  std::vector<std::uint32_t> types;
  for (std::uint32_t left = server.readNumber(1); left > 0; --left) types.push_back(server.readNumber(4));
  return types;
}

}  // namespace

const SecurityType& chooseOrRefuse(std::span<const std::uint32_t> offered, const std::string& where,
                                   const SessionOptions& options) {
  const SecurityLevel require = options.security.require;
  if (const SecurityType* type = chooseSecurityType(offered, require, !options.user.empty())) return *type;
  const std::string offers = where + " offers " + describeSecurityTypes(offered);
  if (chooseSecurityType(offered, SecurityLevel::kNone, false) != nullptr) {
    throw SessionError(CloseKind::kUntrusted,
                       offers + ", which is below the level " + nameOf(require) +
                           " that is required: start it with better SecurityTypes, or ask for less with --require");
  }
  throw SessionError(
      CloseKind::kUntrusted,
      offers + " and no security type known here: start it with SecurityTypes X509Vnc, TLSVnc, VncAuth or None");
}

const SecurityType& agreeOnVenCrypt(HandshakeStream& server, const SessionOptions& options) {
  const SecurityType& type = chooseOrRefuse(readSubTypes(server), server.where(), options);
  server.writeNumber(type.number, 4);
  if (type.level < SecurityLevel::kTls) return type;
  if (server.readNumber(1) != 1) {
    throw SessionError(CloseKind::kUntrusted, server.where() + " offers " + type.name + " but does not begin with it");
  }
  const bool x509 = type.level == SecurityLevel::kX509;
  server.encrypt(x509 ? TlsSession::Kind::kX509 : TlsSession::Kind::kAnonymous, serverName(options.server));
  return type;
}

void logIn(HandshakeStream& server, const SecurityType& type, const SessionOptions& options) {
  switch (type.login) {
    case Login::kNothing:
      return;
    case Login::kPassword:
      return answerChallenge(server, options);
    case Login::kUserAndPassword:
      if (options.user.empty()) {
        refusePassword(server.where(), "a user's name and password", "the name with --user or PIXELFLEX_VNC_USER");
      }
      return sendPlainLogin(server, options);
  }
}

void readLoginResult(HandshakeStream& server, const SecurityType& type, bool givesReason) {
  if (server.readNumber(4) == 0) return;
  const bool afterLogin = type.login != Login::kNothing;
  if (givesReason) throw readRefusal(server, afterLogin);
  throw SessionError(CloseKind::kAuthentication,
                     server.where() + (afterLogin ? " refused the password: check it" : " refused the connection"));
}

SessionError readRefusal(HandshakeStream& server, bool afterLogin) {
  std::string reason;
  try {
    reason = utf8FromEither(server.readText(kMaxReasonBytes));
  } catch (const SessionError&) {
    reason.clear();  // it hung up at once; the refusal is what counts
  }
  const auto isControl = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  std::ranges::replace_if(reason, isControl, ' ');
  const std::string because = reason.empty() ? "" : " (it says: " + reason + ")";
  if (!afterLogin) return {CloseKind::kAuthentication, server.where() + " refused the connection" + because};
  return {CloseKind::kAuthentication, server.where() + " refused the password" + because + ": check it"};
}

}  // namespace pixelflex::viewer
