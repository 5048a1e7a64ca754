#include "viewer/vnc/rfb_failure.h"

#include <string_view>

namespace pixelflex::viewer {
namespace {

bool closedByServer(const RfbLog& log) {
  return log.last() == "VNC server closed connection" ||
         log.last().find("TLS connection was non-properly terminated") != std::string::npos;
}

bool connectionBroke(const RfbLog& log) {
  return log.last().starts_with("read (") || log.last().starts_with("write") ||
         log.last().starts_with("Error reading from TLS") || log.last().starts_with("Error writing to TLS");
}

// Within the time that rfb_state.cpp limits reading to.
bool stoppedHalfWay(const RfbLog& log) {
  return log.last() == "Connection timed out";
}

}  // namespace

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
