#include "viewer/remote/http_server.h"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <set>
#include <utility>

#include "devices/transport/line_loop.h"
#include "viewer/remote/wall_json.h"

namespace pixelflex::viewer {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds kLinger{2};
// A body that comes in chunks of a byte each is so many times as long.
constexpr std::size_t kWrapping = 8;

using WireRequest = http::request<http::string_body>;
using WireReply = http::response<http::string_body>;

std::string textOf(beast::string_view text) {
  return {text.data(), text.size()};
}

HttpRequest messageOf(const WireRequest& wire) {
  return {.method = textOf(wire.method_string()),
          .target = textOf(wire.target()),
          .body = wire.body(),
          .host = textOf(wire[http::field::host]),
          .origin = textOf(wire[http::field::origin]),
          .fetchSite = textOf(wire["Sec-Fetch-Site"]),
          .contentType = textOf(wire[http::field::content_type]),
          .authorization = textOf(wire[http::field::authorization])};
}

WireReply wireOf(const HttpReply& reply, bool keepsAlive) {
  WireReply wire(static_cast<http::status>(reply.status), 11);
  wire.set(http::field::server, "PixelFlex");
  wire.set(http::field::content_type, reply.type);
  wire.set(http::field::cache_control, "no-store");
  wire.set("X-Content-Type-Options", "nosniff");
  wire.set("X-Frame-Options", "DENY");
  wire.set("Referrer-Policy", "no-referrer");
  wire.set("Content-Security-Policy",
           "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; frame-ancestors 'none'");
  for (const auto& [name, value] : reply.headers) wire.set(name, value);
  wire.keep_alive(keepsAlive);
  wire.body() = reply.body;
  wire.prepare_payload();
  return wire;
}

tcp protocolOf(const ListenAddress& at) {
  return asio::ip::make_address(at.host).is_v6() ? tcp::v6() : tcp::v4();
}

/// What to say to somebody whose request cannot be read; nothing when nobody is there any more.
std::optional<HttpReply> complaint(const error_code& error) {
  const auto reply = [](int status, const char* why) {
    return std::optional(HttpReply{.status = status, .body = errorJson(why)});
  };
  if (error == http::error::body_limit) return reply(413, "the body is too long");
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return reply(431, "the headers are too long");
  if (error == beast::error::timeout || error.category() != make_error_code(http::error::bad_version).category() ||
      error == http::error::end_of_stream || error == http::error::partial_message) {
    return std::nullopt;
  }
  return reply(400, "this is no HTTP request");
}

}  // namespace

/// Connections hold it, and outlive the server by the few handlers that are still pending.
struct HttpServer::Core : std::enable_shared_from_this<HttpServer::Core> {
  class Connection;

  Core(asio::io_context& ioContext, const HttpServerOptions& serverOptions, Answer answerer)
      : context(ioContext), options(serverOptions), answer(std::move(answerer)) {}

  void take(int descriptor);
  void close();

  asio::io_context& context;
  HttpServerOptions options;
  Answer answer;
  std::set<Connection*> connections;
};

class HttpServer::Core::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(std::shared_ptr<Core> core, tcp::socket socket)
      : core_(std::move(core)), stream_(std::move(socket)), buffer_(core_->options.headerBytes) {
    core_->connections.insert(this);
  }
  ~Connection() { core_->connections.erase(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(core_->options.headerBytes));
    parser_->body_limit(core_->options.bodyBytes);
    stream_.expires_after(core_->options.patience);
    whole_ = 0;
    readOn();
  }

  void close() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    stream_.close();
  }

 private:
  void readOn() {
    http::async_read_some(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](const error_code& error, std::size_t count) { self->heard(error, count); });
  }

  void heard(error_code error, std::size_t count) {
    if (!core_->answer) return;
    // The parser counts neither short header lines nor what is around the parts of a body.
    whole_ += count;
    const std::size_t head = core_->options.headerBytes;
    if (!error && !parser_->is_header_done() && whole_ > head) error = http::error::header_limit;
    if (!error && whole_ > head + kWrapping * core_->options.bodyBytes) error = http::error::body_limit;
    if (error) {
      const auto reply = complaint(error);
      return reply ? write(*reply, false) : close();
    }
    return parser_->is_done() ? answer() : readOn();
  }

  void answer() {
    const WireRequest& request = parser_->get();
    HttpReply reply = core_->answer(messageOf(request));
    const bool isHead = request.method() == http::verb::head;
    if (isHead) reply.body.clear();
    write(reply, !isHead && request.keep_alive());
  }

  void write(const HttpReply& reply, bool keepsAlive) {
    wire_ = wireOf(reply, keepsAlive);
    stream_.expires_after(core_->options.patience);
    http::async_write(stream_, wire_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->close();
      return self->wire_.need_eof() ? self->linger() : self->read();
    });
  }

  /// Closed while the other side still sends, the connection would be reset and the reply lost.
  void linger() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kLinger);
    discard();
  }

  void discard() {
    stream_.async_read_some(asio::buffer(rest_), [self = shared_from_this()](const error_code& error, std::size_t) {
      return error ? self->close() : self->discard();
    });
  }

  std::shared_ptr<Core> core_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;  // its limit holds whatever way headers come
  std::optional<http::request_parser<http::string_body>> parser_;
  std::size_t whole_ = 0;  // bytes of this request
  WireReply wire_;
  std::array<char, 4096> rest_{};
};

void HttpServer::Core::take(int descriptor) {
  tcp::socket socket(context);
  socket.assign(protocolOf(options.at), descriptor);
  if (connections.size() >= options.connections) return;
  std::make_shared<Connection>(shared_from_this(), std::move(socket))->read();
}

void HttpServer::Core::close() {
  answer = nullptr;
  const auto open = connections;
  for (Connection* connection : open) connection->close();
}

HttpServer::HttpServer(devices::LineLoop& loop, const HttpServerOptions& options, Answer answer)
    : loop_(loop),
      core_(std::make_shared<Core>(loop.context(), options, std::move(answer))),
      listener_(loop, options.at, "HTTP", [core = core_](int descriptor) { core->take(descriptor); }) {}

HttpServer::~HttpServer() {
  loop_.invoke([this] { core_->close(); });
}

}  // namespace pixelflex::viewer
