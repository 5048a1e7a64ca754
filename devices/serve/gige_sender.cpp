#include "devices/serve/gige_sender.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

namespace pixelflex::devices {
namespace {

constexpr std::size_t kRemembered = 2;  // frames
constexpr std::size_t kBurst = 65536;   // bytes, less than any receive buffer holds
constexpr std::chrono::microseconds kRest{400};
constexpr std::size_t kUdpOverhead = 28;

}  // namespace

UdpSocket::UdpSocket(const std::string& address, std::uint16_t port, bool shared)
    : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  const int on = 1;
  if (shared) ::setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (descriptor_ < 0 || ::inet_pton(AF_INET, address.c_str(), &place.sin_addr) != 1 ||
      ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    const std::string why = std::strerror(errno);
    ::close(descriptor_);
    throw std::runtime_error("a GigE Vision camera cannot be served at " + address + " (UDP port " +
                             std::to_string(port) + "): " + why +
                             "; one camera can be served at each address of this machine");
  }
}

UdpSocket::~UdpSocket() {
  ::close(descriptor_);
}

void UdpSocket::send(const Bytes& bytes, const sockaddr_in& to) const {
  (void)::sendto(descriptor_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

GigeSender::GigeSender(GigeRegisters& registers, const std::string& address, GigeCamera::Photograph photograph,
                       GigeCamera::Complain complain)
    : registers_(registers),
      photograph_(std::move(photograph)),
      complain_(std::move(complain)),
      socket_(address, 0, false),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void GigeSender::wake() {
  const std::scoped_lock lock(mutex_);
  ++changes_;
  changed_.notify_all();
}

void GigeSender::abandon() {
  (void)registers_.takeTrigger();
  ++ended_;
  wake();
}

sockaddr_in GigeSender::destination() const {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(registers_.read(GigeRegisters::kStreamPort)));
  place.sin_addr.s_addr = htonl(registers_.read(GigeRegisters::kStreamAddress));
  return place;
}

void GigeSender::sendAgain(std::uint16_t block, std::uint32_t first, std::uint32_t last) const {
  std::shared_ptr<const GigeFrame> frame;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& one : sent_) {
      if (one->block == block) frame = one;
    }
  }
  if (!frame) return;
  for (std::uint32_t i = first; i <= std::min(last, frame->packets() - 1); ++i) {
    socket_.send(frame->packet(i), destination());
  }
}

void GigeSender::sendTest() const {
  const std::size_t size = registers_.read(GigeRegisters::kPacketSize) & 0xffffU;
  if (size > kUdpOverhead) socket_.send(Bytes(size - kUdpOverhead), destination());
}

/// Waits for what the registers ask for.
bool GigeSender::isDue(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto seen = changes_;
  const auto somethingNew = [&] { return changes_ != seen; };
  if (!registers_.acquires()) {
    changed_.wait(lock, stop, somethingNew);
    return false;
  }
  if (registers_.isTriggered()) {
    if (registers_.takeTrigger()) return true;
    changed_.wait(lock, stop, somethingNew);
    return false;
  }
  const std::chrono::duration<double> period(registers_.framePeriod());
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(period);
  // Settings may change meanwhile; that acquisition ends or becomes triggered is seen at the next turn.
  while (!stop.stop_requested() && std::chrono::steady_clock::now() < until) {
    changed_.wait_until(lock, stop, until, [&] { return !registers_.acquires(); });
    if (!registers_.acquires()) return false;
  }
  return !stop.stop_requested();
}

void GigeSender::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (isDue(stop)) takeFrame();
  }
}

void GigeSender::takeFrame() {
  try {
    const std::uint64_t ended = ended_;
    const auto timestamp = std::chrono::steady_clock::now().time_since_epoch();
    auto frame = std::make_shared<GigeFrame>(registers_.frameOf(photograph_(registers_.exposure())));
    if (ended_ != ended) return;
    frame->timestamp =
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(timestamp).count());
    block_ = static_cast<std::uint16_t>(block_ % 65535 + 1);
    frame->block = block_;
    {
      const std::scoped_lock lock(mutex_);
      sent_.push_back(frame);
      if (sent_.size() > kRemembered) sent_.pop_front();
    }
    if (registers_.wantsOneFrame()) registers_.stopAcquisition();
    send(*frame);
  } catch (const std::exception& error) {
    complain_(error.what());
  }
}

/// In bursts: a machine's own network is quicker than who listens.
void GigeSender::send(const GigeFrame& frame) {
  const sockaddr_in to = destination();
  std::size_t inBurst = 0;
  for (std::uint32_t i = 0; i < frame.packets(); ++i) {
    const Bytes packet = frame.packet(i);
    socket_.send(packet, to);
    inBurst += packet.size();
    if (inBurst < kBurst) continue;
    inBurst = 0;
    std::this_thread::sleep_for(kRest);
  }
}

}  // namespace pixelflex::devices
