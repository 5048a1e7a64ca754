#include "tests/bench/rfb_recording.h"

#include <stdexcept>
#include <string>

#include "tests/bench/unix_socket.h"
#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/rfb_messages.h"

namespace pixelflex::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kBetweenRequests = 15ms;
constexpr auto kQuiet = 500ms;  // a server that is not asked any more finishes what it has begun

std::uint32_t number(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t count) {
  return viewer::bigEndian(std::span(bytes).subspan(at, count));
}

devices::Size handshake(const UnixSocket& server) {
  server.write(server.read(12));  // the version, as it is
  const auto types = server.read(server.read(1).front());
  server.write(Message().u8(1).bytes());  // no password
  if (number(server.read(4), 0, 4) != 0) throw std::runtime_error("the server to be recorded wants a password");
  server.write(Message().u8(1).bytes());  // shared
  const auto init = server.read(24);
  (void)server.read(number(init, 20, 4));  // its name
  return {static_cast<int>(number(init, 0, 2)), static_cast<int>(number(init, 2, 2))};
}

void chooseEncodings(const UnixSocket& server) {
  constexpr std::int32_t kQuality8 = -24;
  constexpr std::int32_t kCompression2 = -254;
  server.write(viewer::setPixelFormatMessage());
  Message encodings = Message().u8(2).u8(0).u16(5);
  encodings.s32(viewer::kTightEncoding).s32(viewer::kCopyRectEncoding).s32(viewer::kLastRectEncoding);
  server.write(encodings.s32(kQuality8).s32(kCompression2).bytes());
}

}  // namespace

RfbRecording recordServer(const std::string& socketPath, std::chrono::milliseconds time) {
  const UnixSocket server = UnixSocket::connected(socketPath);
  RfbRecording recording{handshake(server), {}};
  chooseEncodings(server);
  server.write(viewer::updateRequestMessage(false, recording.desktop));
  const auto take = [&](std::chrono::milliseconds patience) {
    const auto bytes = server.readSome(patience);
    recording.messages.insert(recording.messages.end(), bytes.begin(), bytes.end());
    return !bytes.empty();
  };
  const auto end = Clock::now() + time;
  for (auto next = Clock::now() + kBetweenRequests; Clock::now() < end;) {
    (void)take(kBetweenRequests);
    if (Clock::now() < next) continue;
    server.write(viewer::updateRequestMessage(true, recording.desktop));
    next = Clock::now() + kBetweenRequests;
  }
  while (take(kQuiet)) continue;
  return recording;
}

}  // namespace pixelflex::testing
