#pragma once

#include <netinet/in.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "devices/serve/gige_camera.h"
#include "devices/serve/gige_messages.h"
#include "devices/serve/gige_registers.h"

namespace pixelflex::devices {

/// A UDP socket of this machine.
class UdpSocket {
 public:
  /// Bound to `port` of `address`; port 0 is a free one. Throws std::runtime_error.
  UdpSocket(const std::string& address, std::uint16_t port, bool shared);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// What cannot be sent is lost, as on a network.
  void send(const Bytes& bytes, const sockaddr_in& to) const;

 private:
  int descriptor_;
};

/// Takes and sends a camera's frames on a thread of its own, so that taking long delays no answer.
class GigeSender {
 public:
  GigeSender(GigeRegisters& registers, const std::string& address, GigeCamera::Photograph photograph,
             GigeCamera::Complain complain);

  // From any thread.
  /// The registers have changed: perhaps there is something to do.
  void wake();
  /// Acquisition has ended: what is being taken or was triggered is not sent any more.
  void abandon();
  /// Packets of a frame again, while it is remembered.
  void sendAgain(std::uint16_t block, std::uint32_t first, std::uint32_t last) const;
  /// One packet of the size that is set, for clients that try sizes.
  void sendTest() const;

 private:
  void run(const std::stop_token& stop);
  [[nodiscard]] bool isDue(const std::stop_token& stop);
  void takeFrame();
  void send(const GigeFrame& frame);
  [[nodiscard]] sockaddr_in destination() const;

  GigeRegisters& registers_;
  GigeCamera::Photograph photograph_;
  GigeCamera::Complain complain_;
  UdpSocket socket_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::uint64_t changes_ = 0;
  std::atomic<std::uint64_t> ended_ = 0;               // how often acquisition has
  std::deque<std::shared_ptr<const GigeFrame>> sent_;  // the newest last
  std::uint16_t block_ = 0;
  std::jthread thread_;
};

}  // namespace pixelflex::devices
