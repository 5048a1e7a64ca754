#include "viewer/remote/pjlink_server.h"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <set>
#include <utility>

#include "devices/transport/line_loop.h"

namespace pixelflex::viewer {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

}  // namespace

/// Connections hold it, and outlive the server by the few handlers that are still pending.
struct PjlinkServer::Core : std::enable_shared_from_this<PjlinkServer::Core> {
  class Connection;

  Core(asio::io_context& ioContext, PjlinkServerOptions serverOptions, PjlinkSession::Obey obeyer)
      : context(ioContext), options(std::move(serverOptions)), obey(std::move(obeyer)) {}

  void take(int descriptor);
  void close();

  asio::io_context& context;
  PjlinkServerOptions options;
  PjlinkSession::Obey obey;
  std::set<Connection*> connections;
};

/// Reads on only when its answers are written, so that nobody fills memory with them.
class PjlinkServer::Core::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(std::shared_ptr<Core> core, tcp::socket socket)
      : core_(std::move(core)),
        socket_(std::move(socket)),
        timer_(core_->context),
        session_(core_->options.password, core_->obey) {
    core_->connections.insert(this);
  }
  ~Connection() { core_->connections.erase(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void greet() { write(session_.greeting()); }

  void close() {
    error_code ignored;
    timer_.cancel(ignored);
    socket_.shutdown(tcp::socket::shutdown_both, ignored);
    socket_.close(ignored);
  }

 private:
  void read() {
    socket_.async_read_some(asio::buffer(incoming_),
                            [self = shared_from_this()](const error_code& error, std::size_t count) {
                              if (error || !self->core_->obey) return self->close();
                              self->heard(self->session_.receive(std::string_view(self->incoming_.data(), count)));
                            });
  }

  void heard(const std::string& answers) {
    if (session_.isRefused()) return writeLater(answers);
    if (!answers.empty()) return write(answers);
    return session_.wantsClose() ? close() : read();
  }

  void write(const std::string& answers) {
    outgoing_ = answers;
    waitIdle();
    asio::async_write(socket_, asio::buffer(outgoing_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        if (error || self->session_.wantsClose()) return self->close();
                        self->waitIdle();
                        self->read();
                      });
  }

  void writeLater(const std::string& answers) {
    timer_.expires_after(core_->options.refusalDelay);
    timer_.async_wait([self = shared_from_this(), answers](const error_code& error) {
      if (!error) self->write(answers);
    });
  }

  /// Bytes that come to nothing do not count.
  void waitIdle() {
    timer_.expires_after(core_->options.idle);
    timer_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error) self->close();
    });
  }

  std::shared_ptr<Core> core_;
  tcp::socket socket_;
  asio::steady_timer timer_;
  PjlinkSession session_;
  std::array<char, 1024> incoming_{};
  std::string outgoing_;
};

void PjlinkServer::Core::take(int descriptor) {
  tcp::socket socket(context);
  socket.assign(asio::ip::make_address(options.at.host).is_v6() ? tcp::v6() : tcp::v4(), descriptor);
  if (connections.size() >= options.connections) return;
  std::make_shared<Connection>(shared_from_this(), std::move(socket))->greet();
}

void PjlinkServer::Core::close() {
  obey = nullptr;
  const auto open = connections;
  for (Connection* connection : open) connection->close();
}

PjlinkServer::PjlinkServer(devices::LineLoop& loop, const PjlinkServerOptions& options, PjlinkSession::Obey obey)
    : loop_(loop),
      core_(std::make_shared<Core>(loop.context(), options, std::move(obey))),
      listener_(loop, options.at, "PJLink", [core = core_](int descriptor) { core->take(descriptor); }) {}

PjlinkServer::~PjlinkServer() {
  loop_.invoke([this] { core_->close(); });
}

}  // namespace pixelflex::viewer
