#include "devices/serve/gige_camera.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "devices/serve/gige_messages.h"
#include "devices/serve/gige_registers.h"
#include "devices/serve/gige_sender.h"

namespace pixelflex::devices {
namespace {

constexpr std::uint16_t kPort = 3956;
constexpr int kPollTime = 50;  // milliseconds
constexpr int kPatience = 3;   // heartbeats: a client on a busy machine is late, not gone
constexpr std::uint32_t kFireTest = 1U << 31U;

bool isSame(const sockaddr_in& a, const sockaddr_in& b) {
  return a.sin_addr.s_addr == b.sin_addr.s_addr && a.sin_port == b.sin_port;
}

}  // namespace

struct GigeCamera::Impl {
  Impl(const Options& options, Photograph photograph, Complain complain)
      : control(options.address, kPort, false),
        search("255.255.255.255", kPort, true),
        registers(options.serial, options.size, options.address),
        sender(registers, options.address, std::move(photograph), std::move(complain)),
        name("PixelFlex-Room-" + options.serial),
        thread([this](const std::stop_token& stop) { run(stop); }) {}

  void run(const std::stop_token& stop);
  void receive(const UdpSocket& socket);
  [[nodiscard]] Bytes answer(const GigeRequest& request, const sockaddr_in& from);
  [[nodiscard]] Bytes readRegisters(const GigeRequest& request) const;
  [[nodiscard]] Bytes readMemory(const GigeRequest& request) const;
  [[nodiscard]] Bytes writeRegisters(const GigeRequest& request);
  [[nodiscard]] Bytes writeMemory(const GigeRequest& request);
  void writeOne(std::uint32_t address, std::uint32_t value);
  [[nodiscard]] bool mayWrite(const sockaddr_in& from) const { return !controller || isSame(*controller, from); }
  void noteController(const sockaddr_in& from);
  void forgetLostController();

  UdpSocket control;
  UdpSocket search;
  GigeRegisters registers;
  GigeSender sender;
  std::string name;
  std::optional<sockaddr_in> controller;
  std::chrono::steady_clock::time_point heard{};
  std::jthread thread;
};

void GigeCamera::Impl::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> sockets{pollfd{control.descriptor(), POLLIN, 0}, pollfd{search.descriptor(), POLLIN, 0}};
    if (::poll(sockets.data(), sockets.size(), kPollTime) > 0) {
      if (sockets[0].revents != 0) receive(control);
      if (sockets[1].revents != 0) receive(search);
    }
    forgetLostController();
  }
}

void GigeCamera::Impl::receive(const UdpSocket& socket) {
  std::array<std::uint8_t, 2048> packet{};
  sockaddr_in from{};
  socklen_t length = sizeof from;
  const auto count =
      ::recvfrom(socket.descriptor(), packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
  if (count <= 0) return;
  const auto request = parseGigeRequest(std::span(packet).first(static_cast<std::size_t>(count)));
  if (!request) return;
  // Broadcasts come from every network of this machine, also to a camera that is served to itself only.
  if (&socket == &search && request->command != GigeCommand::kDiscovery) return;
  const Bytes reply = answer(*request, from);
  if (!reply.empty()) control.send(reply, from);
}

Bytes GigeCamera::Impl::answer(const GigeRequest& request, const sockaddr_in& from) {
  constexpr std::uint32_t kDiscoverySize = 0xf8;
  if (controller && isSame(*controller, from)) heard = std::chrono::steady_clock::now();
  switch (request.command) {
    case GigeCommand::kDiscovery:
      return gigeAnswer(request, GigeStatus::kSuccess, registers.readBlock(0, kDiscoverySize).value_or(Bytes()));
    case GigeCommand::kResend:
      sender.sendAgain(static_cast<std::uint16_t>(request.number(0)), request.number(1) & 0xffffffU,
                       request.number(2) & 0xffffffU);
      return {};
    case GigeCommand::kReadRegister:
      return readRegisters(request);
    case GigeCommand::kReadMemory:
      return readMemory(request);
    case GigeCommand::kWriteRegister:
    case GigeCommand::kWriteMemory: {
      if (!mayWrite(from)) return gigeAnswer(request, GigeStatus::kAccessDenied, {});
      Bytes reply = request.command == GigeCommand::kWriteRegister ? writeRegisters(request) : writeMemory(request);
      noteController(from);
      return reply;
    }
    default:
      return gigeAnswer(request, GigeStatus::kNotImplemented, {});
  }
}

Bytes GigeCamera::Impl::readRegisters(const GigeRequest& request) const {
  Bytes values;
  for (std::size_t i = 0; i < request.numbers(); ++i) appendNumber(values, registers.read(request.number(i)));
  return gigeAnswer(request, GigeStatus::kSuccess, values);
}

Bytes GigeCamera::Impl::readMemory(const GigeRequest& request) const {
  const auto bytes = registers.readBlock(request.number(0), request.number(1) & 0xffffU);
  if (!bytes) return gigeAnswer(request, GigeStatus::kInvalidAddress, {});
  Bytes reply;
  appendNumber(reply, request.number(0));
  reply.insert(reply.end(), bytes->begin(), bytes->end());
  return gigeAnswer(request, GigeStatus::kSuccess, reply);
}

void GigeCamera::Impl::writeOne(std::uint32_t address, std::uint32_t value) {
  const bool tests = address == GigeRegisters::kPacketSize && (value & kFireTest) != 0;
  registers.write(address, tests ? value & ~kFireTest : value);
  if (tests) sender.sendTest();
}

Bytes GigeCamera::Impl::writeRegisters(const GigeRequest& request) {
  const std::size_t count = request.numbers() / 2;
  const bool acquired = registers.acquires();
  for (std::size_t i = 0; i < count; ++i) writeOne(request.number(2 * i), request.number(2 * i + 1));
  if (acquired && !registers.acquires()) sender.abandon();
  sender.wake();
  Bytes written;
  appendNumber(written, static_cast<std::uint32_t>(count));
  return gigeAnswer(request, GigeStatus::kSuccess, written);
}

Bytes GigeCamera::Impl::writeMemory(const GigeRequest& request) {
  constexpr std::size_t kAddress = 4;
  if (request.numbers() == 2 && request.data.size() == 8) return writeRegisters(request);
  if (request.data.size() <= kAddress ||
      !registers.writeBlock(request.number(0), Bytes(request.data.begin() + kAddress, request.data.end()))) {
    return gigeAnswer(request, GigeStatus::kInvalidAddress, {});
  }
  sender.wake();
  Bytes written;
  appendNumber(written, static_cast<std::uint32_t>(request.data.size() - kAddress));
  return gigeAnswer(request, GigeStatus::kSuccess, written);
}

void GigeCamera::Impl::noteController(const sockaddr_in& from) {
  if (registers.read(GigeRegisters::kPrivilege) == 0) {
    controller.reset();
  } else if (!controller) {
    controller = from;
    heard = std::chrono::steady_clock::now();
  }
}

void GigeCamera::Impl::forgetLostController() {
  if (!controller) return;
  const std::chrono::milliseconds timeout(registers.read(GigeRegisters::kHeartbeatTimeout));
  if (std::chrono::steady_clock::now() - heard < kPatience * timeout) return;
  controller.reset();
  registers.write(GigeRegisters::kPrivilege, 0);
  registers.stopAcquisition();
  sender.abandon();
}

GigeCamera::GigeCamera(const Options& options, Photograph photograph, Complain complain)
    : impl_(std::make_unique<Impl>(options, std::move(photograph), std::move(complain))) {}
GigeCamera::~GigeCamera() = default;

const std::string& GigeCamera::name() const {
  return impl_->name;
}

}  // namespace pixelflex::devices
