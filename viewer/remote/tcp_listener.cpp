#include "viewer/remote/tcp_listener.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "devices/transport/line_loop.h"

namespace pixelflex::viewer {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

// When the process is out of descriptors.
constexpr std::chrono::milliseconds kPause{200};

}  // namespace

/// Outlives the listener by the handlers that are still pending.
struct TcpListener::Core : std::enable_shared_from_this<TcpListener::Core> {
  Core(asio::io_context& context, Take taker) : take(std::move(taker)), acceptor(context), pause(context) {}

  void open(const ListenAddress& at) {
    const tcp::endpoint place(asio::ip::make_address(at.host), at.port);
    acceptor.open(place.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(place);
    acceptor.listen();
    accept();
  }

  void accept() {
    acceptor.async_accept([core = shared_from_this()](const error_code& error, tcp::socket socket) {
      if (!core->take) return;
      if (error) return core->acceptLater();
      socket.set_option(tcp::no_delay(true));
      core->take(socket.release());
      core->accept();
    });
  }

  void acceptLater() {
    pause.expires_after(kPause);
    pause.async_wait([core = shared_from_this()](const error_code&) {
      if (core->take) core->accept();
    });
  }

  void close() {
    take = nullptr;
    error_code ignored;
    acceptor.close(ignored);
    pause.cancel(ignored);
  }

  Take take;
  tcp::acceptor acceptor;
  asio::steady_timer pause;
};

TcpListener::TcpListener(devices::LineLoop& loop, const ListenAddress& at, const std::string& protocol, Take take)
    : loop_(loop), core_(std::make_shared<Core>(loop.context(), std::move(take))), address_(at) {
  try {
    loop_.invoke([this] {
      core_->open(address_);
      address_.port = core_->acceptor.local_endpoint().port();
    });
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error("nothing can listen at " + at.text() + " for " + protocol + ": " + error.code().message());
  }
}

TcpListener::~TcpListener() {
  loop_.invoke([this] { core_->close(); });
}

}  // namespace pixelflex::viewer
