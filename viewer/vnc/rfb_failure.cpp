#include "viewer/vnc/rfb_failure.h"

#include <string_view>

namespace pixelflex::viewer {
namespace {

bool closedByServer(const RfbLog& log) {
  return log.last() == "VNC server closed connection";
}

bool connectionBroke(const RfbLog& log) {
  return log.last().starts_with("read (") || log.last().starts_with("write");
}

// Within the time that rfb_state.cpp limits reading to.
bool stoppedHalfWay(const RfbLog& log) {
  return log.last() == "Connection timed out";
}

SessionError refusal(const HandshakeState& state, const std::string& reason) {
  const std::string because = reason.empty() ? "" : " (it says: " + reason + ")";
  if (state.passwordGiven) {
    return {CloseKind::kAuthentication, state.where + " refused the password" + because + ": check it"};
  }
  return {CloseKind::kAuthentication, state.where + " refused the connection" + because};
}

}  // namespace

SessionError handshakeFailure(const HandshakeState& state, const RfbLog& log) {
  constexpr std::string_view kRefused = "VNC connection failed: ";
  constexpr std::string_view kUnknownScheme = "Unknown authentication scheme from VNC server: ";
  const std::string& last = log.last();
  if (state.timedOut) {
    return {CloseKind::kUnreachable, state.where + " accepted the connection but stopped answering"};
  }
  if (state.passwordAsked && !state.passwordGiven) {
    return {CloseKind::kAuthentication, state.where + " asks for a password: give it with --password-file"};
  }
  if (last.starts_with(kRefused)) return refusal(state, last.substr(kRefused.size()));
  if (last.starts_with("VNC authentication failed")) return refusal(state, "");
  if (last.starts_with(kUnknownScheme)) {
    return {CloseKind::kAuthentication, state.where + " offers no security type known here (it offers " +
                                            last.substr(kUnknownScheme.size()) +
                                            "): start it with SecurityTypes None or VncAuth"};
  }
  if (closedByServer(log)) {
    return {CloseKind::kLost, state.where + " closed the connection during the handshake"};
  }
  return streamFailure(state.where, false, log);
}

SessionError streamFailure(const std::string& where, bool insideUpdate, const RfbLog& log) {
  const std::string when = insideUpdate ? " in the middle of an update" : "";
  if (closedByServer(log)) return {CloseKind::kLost, where + " closed the connection" + when};
  if (stoppedHalfWay(log)) return {CloseKind::kLost, where + " stopped answering" + when};
  if (connectionBroke(log))
    return {CloseKind::kLost, "the connection to " + where + " broke" + when + ": " + log.last()};
  const std::string what = log.last().empty() ? "no details" : log.last();
  return {CloseKind::kProtocol, where + " sent something that is not valid VNC" + when + ": " + what};
}

SessionError notVnc(const std::string& where, const std::string& greeting) {
  std::string printable;
  for (const char c : greeting) printable += c >= ' ' && c <= '~' ? c : '.';
  return {CloseKind::kNotVnc, where + " is not a VNC server (it begins with \"" + printable + "\"): check the port"};
}

}  // namespace pixelflex::viewer
