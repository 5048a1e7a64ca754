#include "viewer/vnc/rfb_handshake.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <string_view>
#include <vector>

#include "viewer/vnc/certificate_check.h"
#include "viewer/vnc/connector.h"
#include "viewer/vnc/handshake_stream.h"
#include "viewer/vnc/login.h"
#include "viewer/vnc/rfb_failure.h"
#include "viewer/vnc/security_types.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

constexpr std::string_view kGreeting = "RFB 003.008\n";
constexpr std::size_t kMaxNameBytes = std::size_t{64} << 10;

// Minor versions of RFB 3 that differ in the handshake.
constexpr int kFirstWithTypeList = 7;
constexpr int kLast = 8;

std::string readGreeting(HandshakeStream& server) {
  std::string greeting;
  while (greeting.size() < kGreeting.size()) {
    try {
      greeting += server.readSome(kGreeting.size() - greeting.size());
    } catch (const SessionError& error) {
      if (error.kind() != CloseKind::kUnreachable) throw;
      throw SessionError(CloseKind::kUnreachable,
                         server.where() + " accepts connections but says nothing: is it a VNC server?");
    }
    if (!greeting.starts_with(kGreeting.substr(0, 4).substr(0, greeting.size()))) {
      throw notVnc(server.where(), greeting);
    }
  }
  return greeting;
}

// The minor version of RFB 3 to go on with: 3, 7 or 8.
int agreeOnVersion(HandshakeStream& server) {
  const std::string greeting = readGreeting(server);
  constexpr std::string_view kForm = "RFB ddd.ddd\n";
  for (std::size_t i = 4; i < kForm.size(); ++i) {
    const bool fits =
        kForm[i] == 'd' ? std::isdigit(static_cast<unsigned char>(greeting[i])) != 0 : greeting[i] == kForm[i];
    if (!fits) throw notVnc(server.where(), greeting);
  }
  const int major = std::stoi(greeting.substr(4, 3));
  const int minor = std::stoi(greeting.substr(8, 3));
  int agreed = 3;
  if (major > 3 || (major == 3 && minor >= kLast)) agreed = kLast;
  if (major == 3 && minor == kFirstWithTypeList) agreed = kFirstWithTypeList;
  std::string answer(kGreeting);
  answer[answer.size() - 2] = static_cast<char>('0' + agreed);
  server.write({reinterpret_cast<const std::uint8_t*>(answer.data()), answer.size()});
  return agreed;
}

std::vector<std::uint32_t> readTypes(HandshakeStream& server, int version) {
  std::vector<std::uint32_t> types;
  if (version < kFirstWithTypeList) {
    types.push_back(server.readNumber(4));
  } else {
    for (std::uint32_t left = server.readNumber(1); left > 0; --left) types.push_back(server.readNumber(1));
  }
  const bool refused = types.empty() || types.front() == kRefusedType;
  if (refused) throw readRefusal(server, false);
  return types;
}

// The security type that was gone through, up to but without its login.
const SecurityType& agreeOnSecurity(HandshakeStream& server, const SessionOptions& options, int version) {
  const std::vector<std::uint32_t> types = readTypes(server, version);
  if (std::ranges::find(types, kVeNCryptType) != types.end()) {
    if (version >= kFirstWithTypeList) server.writeNumber(kVeNCryptType, 1);
    return agreeOnVenCrypt(server, options);
  }
  const SecurityType& type = chooseOrRefuse(types, server.where(), options);
  if (version >= kFirstWithTypeList) server.writeNumber(type.number, 1);
  return type;
}

void readServerInit(HandshakeStream& server, Handshake& result) {
  result.desktop.width = static_cast<int>(server.readNumber(2));
  result.desktop.height = static_cast<int>(server.readNumber(2));
  (void)server.read(16);  // its pixel format; we ask for our own
  const std::uint32_t length = server.readNumber(4);
  if (length > kMaxNameBytes) {
    throw SessionError(CloseKind::kProtocol,
                       server.where() + " announces a desktop name of " + std::to_string(length) + " bytes");
  }
  const std::vector<std::uint8_t> name = server.read(length);
  result.desktopName.assign(name.begin(), name.end());
}

}  // namespace

Handshake shakeHands(int socket, const SessionOptions& options, Deadline deadline, const Signal& stop) {
  HandshakeStream server(socket, describeServer(options.server), deadline, stop);
  const int version = agreeOnVersion(server);
  const SecurityType& type = agreeOnSecurity(server, options, version);
  Handshake result;
  result.security.level = type.level;
  if (type.level == SecurityLevel::kX509) {
    result.security.newFingerprint = checkCertificate(server.tls()->certificates(), options.server, options.security);
  } else {
    refuseForgottenCertificate(options.server, options.security);
  }
  logIn(server, type, options);
  const bool saysResult = version >= kLast || type.number != kNoneType;
  if (saysResult) readLoginResult(server, type, version >= kLast);
  server.writeNumber(options.shared ? 1 : 0, 1);
  readServerInit(server, result);
  if (server.tls() != nullptr) server.tls()->letReadsBlock();
  result.tls = server.takeTls();
  return result;
}

}  // namespace pixelflex::viewer
