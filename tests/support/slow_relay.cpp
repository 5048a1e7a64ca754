#include "tests/support/slow_relay.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <stdexcept>
#include <vector>

namespace pixelflex::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPacket = 1448;
constexpr std::size_t kMostPackets = 64;  // on their way; more stay with their sender

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int makeSocket() {
  const int made = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (made < 0) throw std::runtime_error("cannot make a socket");
  return made;
}

/// One direction.
class Way {
 public:
  Way(int from, int to, double bytesPerSecond, std::chrono::milliseconds delay)
      : from_(from), to_(to), bytesPerSecond_(bytesPerSecond), delay_(delay) {}

  [[nodiscard]] int reads() const { return packets_.size() < kMostPackets ? from_ : -1; }
  /// False when the sender is gone.
  bool take() {
    Packet packet;
    packet.bytes.resize(kPacket);
    const ssize_t count = ::recv(from_, packet.bytes.data(), packet.bytes.size(), 0);
    if (count <= 0) return false;
    packet.bytes.resize(static_cast<std::size_t>(count));
    const auto sending = std::chrono::duration<double>(static_cast<double>(count) / bytesPerSecond_);
    free_ = std::max(free_, Clock::now()) + std::chrono::duration_cast<Clock::duration>(sending);
    packet.due = free_ + delay_;
    packets_.push_back(std::move(packet));
    return true;
  }
  /// Hands over what is due.
  void give() {
    for (; !packets_.empty() && packets_.front().due <= Clock::now(); packets_.pop_front()) {
      const auto& bytes = packets_.front().bytes;
      (void)::send(to_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
  }
  [[nodiscard]] Clock::time_point due() const {
    return packets_.empty() ? Clock::time_point::max() : packets_.front().due;
  }

 private:
  struct Packet {
    std::vector<char> bytes;
    Clock::time_point due;
  };
  int from_, to_;
  double bytesPerSecond_;
  std::chrono::milliseconds delay_;
  Clock::time_point free_;  // when the line is
  std::deque<Packet> packets_;
};

int waitTime(const Way& down, const Way& up) {
  constexpr std::chrono::milliseconds kLook{50};  // for the end
  const auto wait = std::min<Clock::duration>(std::min(down.due(), up.due()) - Clock::now(), kLook);
  return static_cast<int>(std::max<std::int64_t>(0, std::chrono::ceil<std::chrono::milliseconds>(wait).count()));
}

void relay(int client, int server, RelayLimits limits, const std::stop_token& stop) {
  Way down(server, client, limits.bytesPerSecond, limits.delay);
  Way up(client, server, 1e9, limits.delay);
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> watched{{{down.reads(), POLLIN, 0}, {up.reads(), POLLIN, 0}}};
    ::poll(watched.data(), watched.size(), waitTime(down, up));
    if (watched[0].revents != 0 && !down.take()) return;
    if (watched[1].revents != 0 && !up.take()) return;
    down.give();
    up.give();
  }
}

}  // namespace

SlowRelay::SlowRelay(int server, RelayLimits limits) : listener_(makeSocket()) {
  sockaddr_in address = loopback(0);
  socklen_t length = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, generic, length) != 0 || ::listen(listener_, 1) != 0 ||
      ::getsockname(listener_, generic, &length) != 0) {
    throw std::runtime_error("cannot listen");
  }
  address_ = "127.0.0.1::" + std::to_string(ntohs(address.sin_port));
  thread_ = std::jthread([this, server, limits](const std::stop_token& stop) { serve(stop, server, limits); });
}

SlowRelay::~SlowRelay() {
  thread_.request_stop();
  ::shutdown(listener_, SHUT_RDWR);  // ends a waiting accept()
  thread_.join();
  ::close(listener_);
}

void SlowRelay::serve(const std::stop_token& stop, int server, RelayLimits limits) const {
  const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client < 0) return;
  const int onward = makeSocket();
  const int small = 16 << 10;  // what the kernel holds back is no part of the limits
  ::setsockopt(onward, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  sockaddr_in address = loopback(server);
  if (::connect(onward, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    relay(client, onward, limits, stop);
  }
  ::close(client);
  ::close(onward);
}

}  // namespace pixelflex::testing
