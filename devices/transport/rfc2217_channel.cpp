#include <array>
#include <utility>

#include "devices/transport/channels.h"
#include "devices/transport/telnet_codec.h"

namespace pixelflex::devices {
namespace {

using Codec = TelnetCodec;

// Commands to the server; its answers are larger by 100.
constexpr unsigned char kSetBaud = 1;
constexpr unsigned char kSetDataSize = 2;
constexpr unsigned char kSetParity = 3;
constexpr unsigned char kSetStopSize = 4;
constexpr unsigned char kSetControl = 5;
constexpr unsigned char kPurge = 12;
constexpr unsigned char kAnswer = 100;
constexpr char kNoFlowControl = 1;
constexpr char kPurgeBoth = 3;

std::string fourBytes(int number) {
  const auto bits = static_cast<unsigned>(number);
  return {static_cast<char>(bits >> 24), static_cast<char>(bits >> 16), static_cast<char>(bits >> 8),
          static_cast<char>(bits)};
}

std::string comPort(unsigned char command, const std::string& value) {
  return Codec::subnegotiation(Codec::kComPort, static_cast<char>(command) + value);
}

/// Opened once the server has said what its line is set to.
class Rfc2217Channel : public Channel {
 public:
  Rfc2217Channel(boost::asio::io_context& context, const LineAddress& address)
      : format_(address.format), tcp_(makeTcpChannel(context, address)) {}

  void open(Events events) override {
    events_ = std::move(events);
    tcp_->open({[this] { negotiate(); }, [this](std::string_view bytes) { receive(bytes); },
                [this](const std::string& why) { fail(why); }});
  }
  void write(std::string bytes) override { tcp_->write(Codec::encode(bytes)); }
  [[nodiscard]] bool isWriting() const override { return tcp_->isWriting(); }

 private:
  void negotiate() {
    tcp_->write(Codec::command(Codec::kWill, Codec::kComPort) + Codec::command(Codec::kWill, Codec::kBinary) +
                Codec::command(Codec::kDo, Codec::kBinary) + Codec::command(Codec::kDo, Codec::kSuppressGoAhead));
  }

  void setUp() {
    const char parity = format_.parity == 'O' ? 2 : format_.parity == 'E' ? 3 : 1;
    tcp_->write(comPort(kSetBaud, fourBytes(format_.baud)) +
                comPort(kSetDataSize, {static_cast<char>(format_.dataBits)}) + comPort(kSetParity, {parity}) +
                comPort(kSetStopSize, {static_cast<char>(format_.stopBits)}) +
                // Terminals without modem lines never answer these two, so nothing waits for them.
                comPort(kSetControl, {kNoFlowControl}) + comPort(kPurge, {kPurgeBoth}));
  }

  void receive(std::string_view bytes) {
    const Codec::Decoded decoded = codec_.decode(bytes);
    for (const auto& command : decoded.commands) {
      if (!failed_) obey(command);
    }
    if (!failed_ && opened_ && !decoded.data.empty()) events_.received(decoded.data);
  }

  void obey(const Codec::Command& command) {
    if (command.verb == 0) {
      if (command.option == Codec::kComPort && !command.value.empty()) hear(command.value);
    } else if (command.option == Codec::kComPort) {
      answerComPort(command.verb);
    } else if (command.verb == Codec::kWill || command.verb == Codec::kDo) {
      agree(command);
    }
  }

  void answerComPort(unsigned char verb) {
    if (verb == Codec::kDont || verb == Codec::kWont) {
      fail("the server does not set serial lines (RFC 2217): give its raw port as tcp://");
    } else if (verb == Codec::kDo && !std::exchange(settingUp_, true)) {
      setUp();
    }
  }

  /// Once for each option, so that two polite ends do not agree for ever.
  void agree(const Codec::Command& command) {
    const bool known = command.option == Codec::kBinary || command.option == Codec::kSuppressGoAhead;
    const bool will = command.verb == Codec::kWill;
    bool& answered = answered_.at(command.option).at(will ? 0 : 1);
    if (std::exchange(answered, true) || (known && command.option == Codec::kBinary)) return;  // was asked by us
    const unsigned char yes = will ? Codec::kDo : Codec::kWill;
    const unsigned char no = will ? Codec::kDont : Codec::kWont;
    tcp_->write(Codec::command(known ? yes : no, command.option));
  }

  void hear(const std::string& answer) {
    const auto command = static_cast<unsigned char>(answer.front());
    if (command <= kAnswer || command > kAnswer + kSetStopSize || opened_) return;
    if (command == kAnswer + kSetBaud && answer.substr(1) != fourBytes(format_.baud)) {
      return fail("the server cannot set its line to " + std::to_string(format_.baud) + " baud");
    }
    set_.at(command - kAnswer - 1U) = true;
    for (const bool done : set_) {
      if (!done) return;
    }
    opened_ = true;
    events_.opened();
  }

  void fail(const std::string& why) {
    if (std::exchange(failed_, true)) return;
    const auto closed = events_.closed;
    if (closed) closed(why);
  }

  SerialFormat format_;
  std::unique_ptr<Channel> tcp_;
  Events events_;
  Codec codec_;
  std::array<std::array<bool, 2>, 256> answered_{};
  std::array<bool, 4> set_{};  // baud, data size, parity, stop size
  bool settingUp_ = false;
  bool opened_ = false;
  bool failed_ = false;
};

}  // namespace

std::unique_ptr<Channel> makeRfc2217Channel(boost::asio::io_context& context, const LineAddress& address) {
  return std::make_unique<Rfc2217Channel>(context, address);
}

}  // namespace pixelflex::devices
