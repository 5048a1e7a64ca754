#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "devices/transport/channels.h"

namespace pixelflex::devices {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

/// What is the same for files and sockets. Handlers hold it while they are pending; the channel that owns it closes it.
template <class Stream>
class Pump : public std::enable_shared_from_this<Pump<Stream>> {
 public:
  explicit Pump(asio::io_context& context) : stream_(context) {}

  Stream& stream() { return stream_; }
  void setEvents(Channel::Events events) { events_ = std::move(events); }
  [[nodiscard]] bool isWriting() const { return !outgoing_.empty(); }

  void begin() {
    if (events_.opened) events_.opened();
    read();
  }

  void write(std::string bytes) {
    const bool idle = outgoing_.empty();
    waiting_ += bytes;
    if (idle) writeOn();
  }

  /// From our side: silence.
  void close() {
    events_ = {};
    error_code ignored;
    stream_.close(ignored);
  }

  void fail(const std::string& why) {
    const auto closed = std::exchange(events_, {}).closed;
    close();
    if (closed) closed(why);
  }

 private:
  void read() {
    stream_.async_read_some(asio::buffer(incoming_),
                            [self = this->shared_from_this()](const error_code& error, std::size_t count) {
                              if (error) return self->fail(self->reason(error));
                              // By value: the event may close this.
                              const auto received = self->events_.received;
                              if (!received) return;
                              received(std::string_view(self->incoming_.data(), count));
                              if (self->events_.received) self->read();
                            });
  }

  void writeOn() {
    outgoing_ = std::exchange(waiting_, {});
    if (outgoing_.empty()) return;
    asio::async_write(stream_, asio::buffer(outgoing_),
                      [self = this->shared_from_this()](const error_code& error, std::size_t) {
                        self->outgoing_.clear();
                        if (error) return self->fail(self->reason(error));
                        self->writeOn();
                      });
  }

  static std::string reason(const error_code& error) {
    // A terminal whose other end has gone reads as an input/output error.
    const bool ended = error == asio::error::eof || error.value() == EIO;
    return ended ? "the other end closed it" : error.message();
  }

  Stream stream_;
  Channel::Events events_;
  std::array<char, 4096> incoming_{};
  std::string outgoing_;  // being written
  std::string waiting_;   // to be written after it
};

class TcpChannel : public Channel {
 public:
  TcpChannel(asio::io_context& context, const LineAddress& address)
      : host_(address.host),
        port_(std::to_string(address.port)),
        resolver_(context),
        pump_(std::make_shared<Pump<tcp::socket>>(context)) {}
  ~TcpChannel() override { pump_->close(); }
  TcpChannel(const TcpChannel&) = delete;
  TcpChannel& operator=(const TcpChannel&) = delete;

  void open(Events events) override {
    pump_->setEvents(std::move(events));
    resolver_.async_resolve(host_, port_,
                            [pump = pump_](const error_code& error, const tcp::resolver::results_type& found) {
                              if (error == asio::error::operation_aborted) return;
                              if (error) return pump->fail("that host is not known");
                              connect(pump, found);
                            });
  }
  void write(std::string bytes) override { pump_->write(std::move(bytes)); }
  [[nodiscard]] bool isWriting() const override { return pump_->isWriting(); }

 private:
  static void connect(const std::shared_ptr<Pump<tcp::socket>>& pump, const tcp::resolver::results_type& found) {
    asio::async_connect(pump->stream(), found, [pump](const error_code& error, const tcp::endpoint&) {
      if (error == asio::error::operation_aborted) return;
      if (error) return pump->fail(error.message());
      error_code ignored;
      pump->stream().set_option(tcp::no_delay(true), ignored);
      pump->stream().set_option(asio::socket_base::keep_alive(true), ignored);
      pump->begin();
    });
  }

  std::string host_;
  std::string port_;
  tcp::resolver resolver_;
  std::shared_ptr<Pump<tcp::socket>> pump_;
};

class SerialChannel : public Channel {
 public:
  SerialChannel(asio::io_context& context, LineAddress address)
      : address_(std::move(address)), pump_(std::make_shared<Pump<asio::serial_port>>(context)) {}
  ~SerialChannel() override {
    if (pump_->stream().is_open()) ::ioctl(pump_->stream().native_handle(), TIOCNXCL);
    pump_->close();
  }
  SerialChannel(const SerialChannel&) = delete;
  SerialChannel& operator=(const SerialChannel&) = delete;

  void open(Events events) override {
    pump_->setEvents(std::move(events));
    error_code error;
    pump_->stream().open(address_.path, error);
    if (!error) setUp(error);
    // Not from here: the caller is not ready for an event yet.
    asio::post(pump_->stream().get_executor(), [pump = pump_, error] {
      if (error) return pump->fail(error.message());
      pump->begin();
    });
  }
  void write(std::string bytes) override { pump_->write(std::move(bytes)); }
  [[nodiscard]] bool isWriting() const override { return pump_->isWriting(); }

 private:
  void setUp(error_code& error) {
    using Port = asio::serial_port;
    const SerialFormat& format = address_.format;
    const auto parity = format.parity == 'E'   ? Port::parity::even
                        : format.parity == 'O' ? Port::parity::odd
                                               : Port::parity::none;
    const auto stop = format.stopBits == 2 ? Port::stop_bits::two : Port::stop_bits::one;
    Port& port = pump_->stream();
    port.set_option(Port::baud_rate(static_cast<unsigned>(format.baud)), error);
    if (!error) port.set_option(Port::character_size(static_cast<unsigned>(format.dataBits)), error);
    if (!error) port.set_option(Port::parity(parity), error);
    if (!error) port.set_option(Port::stop_bits(stop), error);
    if (!error) port.set_option(Port::flow_control(Port::flow_control::none), error);
    if (error) return;
    // Two programs on one line would read each other's replies. The first holds for root as well, the second for
    // programs that do not ask.
    if (::flock(port.native_handle(), LOCK_EX | LOCK_NB) != 0) {
      error = error_code(EBUSY, boost::system::system_category());
      return;
    }
    ::ioctl(port.native_handle(), TIOCEXCL);
    ::tcflush(port.native_handle(), TCIOFLUSH);
  }

  LineAddress address_;
  std::shared_ptr<Pump<asio::serial_port>> pump_;
};

}  // namespace

std::unique_ptr<Channel> makeSerialChannel(asio::io_context& context, const LineAddress& address) {
  return std::make_unique<SerialChannel>(context, address);
}

std::unique_ptr<Channel> makeTcpChannel(asio::io_context& context, const LineAddress& address) {
  return std::make_unique<TcpChannel>(context, address);
}

std::unique_ptr<Channel> makeChannel(asio::io_context& context, const LineAddress& address) {
  switch (address.kind) {
    case LineKind::kSerial:
      return makeSerialChannel(context, address);
    case LineKind::kTcp:
      return makeTcpChannel(context, address);
    case LineKind::kRfc2217:
      return makeRfc2217Channel(context, address);
    case LineKind::kSimulated:
      break;
  }
  return makeSimulatedChannel(context, address);
}

}  // namespace pixelflex::devices
