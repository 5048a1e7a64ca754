#include "tests/bench/replay_server.h"

#include <algorithm>
#include <stdexcept>

#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/rfb_messages.h"

namespace pixelflex::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint8_t kFence = 248;

/// A pixel in black, by a fill that resets all four zlib streams.
std::vector<std::uint8_t> freshStreams() {
  return Message().update(1).rect(0, 0, 1, 1, viewer::kTightEncoding).u8(0x8f).u8(0).u8(0).u8(0).bytes();
}

std::vector<std::uint8_t> fence() {
  return Message().u8(kFence).u8(0).u16(0).u32(1U << 31).u8(0).bytes();
}

/// Of a viewer's message that begins so; 0: not known yet.
std::size_t lengthOf(std::span<const std::uint8_t> said) {
  const auto at = [&said](std::size_t offset, std::size_t count) {
    return said.size() < offset + count ? std::uint32_t{0} : viewer::bigEndian(said.subspan(offset, count));
  };
  const auto withList = [&](std::size_t head, std::size_t offset, std::size_t bytes, std::size_t each) {
    return said.size() < head ? 0 : head + each * at(offset, bytes);
  };
  switch (said.front()) {
    case 0:
      return 20;  // pixel format
    case 2:
      return withList(4, 2, 2, 4);  // encodings
    case 3:
      return 10;  // asks for an update
    case 4:
      return 8;  // key
    case 5:
      return 6;  // pointer
    case 6:
      return withList(8, 4, 4, 1);  // clipboard
    case 150:
      return 10;  // continuous updates
    case kFence:
      return withList(9, 8, 1, 1);
    case 251:
      return withList(8, 6, 1, 16);  // desktop size
    default:
      throw std::runtime_error("the viewer says something unknown");
  }
}

}  // namespace

ReplayServer::ReplayServer(const RfbRecording& recording)
    : recording_(recording), path_((folder_.path() / "replay").string()), listener_(UnixSocket::listening(path_)) {}

void ReplayServer::accept() {
  viewer_.emplace(listener_.accept());
  said_.clear();
  viewer_->write(Message().text("RFB 003.008\n").bytes());
  (void)viewer_->read(12);
  viewer_->write(Message().u8(1).u8(1).bytes());
  (void)viewer_->read(1);
  viewer_->write(Message().u32(0).bytes());
  (void)viewer_->read(1);
  const auto [width, height] = recording_.desktop;
  Message init = Message().u16(static_cast<std::uint32_t>(width)).u16(static_cast<std::uint32_t>(height));
  init.u8(32).u8(24).u8(0).u8(1).u16(255).u16(255).u16(255).u8(16).u8(8).u8(0).repeat(0, 3);
  viewer_->write(init.u32(6).text("replay").bytes());
}

std::chrono::nanoseconds ReplayServer::play() {
  const int answers = answers_;
  const auto start = Clock::now();
  send(freshStreams());
  send(recording_.messages);
  send(fence());
  while (answers_ == answers) {
    viewer_->wait(false);
    takeMessages();
  }
  return Clock::now() - start;
}

void ReplayServer::send(const std::vector<std::uint8_t>& bytes) {
  std::span<const std::uint8_t> left(bytes);
  while (!left.empty()) {
    constexpr std::size_t kPiece = 65536;
    const std::size_t sent = viewer_->writeSome(left.first(std::min(left.size(), kPiece)));
    left = left.subspan(sent);
    if (sent > 0) continue;
    viewer_->wait(true);
    takeMessages();
  }
}

void ReplayServer::takeMessages() {
  const auto bytes = viewer_->readSome(std::chrono::milliseconds(0));
  said_.insert(said_.end(), bytes.begin(), bytes.end());
  while (takeMessage()) continue;
}

bool ReplayServer::takeMessage() {
  if (said_.empty()) return false;
  const std::size_t length = lengthOf(said_);
  if (length == 0 || said_.size() < length) return false;
  if (said_.front() == kFence) ++answers_;
  said_.erase(said_.begin(), said_.begin() + static_cast<std::ptrdiff_t>(length));
  return true;
}

}  // namespace pixelflex::testing
