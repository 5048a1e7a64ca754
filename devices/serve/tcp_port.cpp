#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <stdexcept>
#include <utility>

#include "devices/serve/host_port.h"

namespace pixelflex::devices {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMostUnread = 65536;

/// Handlers hold it while they are pending.
struct Client {
  explicit Client(tcp::socket accepted) : socket(std::move(accepted)) {}
  tcp::socket socket;
  std::array<char, 4096> incoming{};
  std::string outgoing;  // being written
  std::string waiting;
  bool ends = false;  // once all is written
};

class TcpPort : public HostPort {
 public:
  TcpPort(asio::io_context& context, std::unique_ptr<SimulatedDevice> device, std::string host, int port)
      : HostPort(context, std::move(device)),
        context_(context),
        host_(std::move(host)),
        port_(port),
        alive_(std::make_shared<bool>(true)) {}
  ~TcpPort() override {
    *alive_ = false;
    TcpPort::closeLine();
  }
  TcpPort(const TcpPort&) = delete;
  TcpPort& operator=(const TcpPort&) = delete;

  [[nodiscard]] std::string address() const override {
    return LineAddress{.kind = LineKind::kTcp, .host = host_, .port = port_}.text();
  }

  void openLine() override {
    acceptor_ = std::make_unique<tcp::acceptor>(context_);
    try {
      tcp::resolver resolver(context_);
      const tcp::endpoint place = *resolver.resolve(host_, std::to_string(port_)).begin();
      acceptor_->open(place.protocol());
      acceptor_->set_option(tcp::acceptor::reuse_address(true));
      acceptor_->bind(place);
      acceptor_->listen();
    } catch (const boost::system::system_error& error) {
      acceptor_.reset();
      throw std::runtime_error(address() + ": nothing can listen there: " + error.code().message());
    }
    port_ = acceptor_->local_endpoint().port();
    accept();
  }

  void closeLine() override {
    error_code ignored;
    if (acceptor_) acceptor_->close(ignored);
    acceptor_.reset();
    dropClient();
  }

 protected:
  void give(const std::string& bytes) override {
    if (!client_ || client_->waiting.size() > kMostUnread) return;
    client_->waiting += bytes;
    if (client_->outgoing.empty()) writeOn(client_);
  }

  void endClient() override {
    if (!client_) return;
    client_->ends = true;
    if (client_->outgoing.empty()) dropClient();
  }

 private:
  void accept() {
    acceptor_->async_accept([this, alive = alive_](const error_code& error, tcp::socket socket) {
      if (error || !*alive || !acceptor_) return;
      dropClient();
      client_ = std::make_shared<Client>(std::move(socket));
      error_code ignored;
      client_->socket.set_option(tcp::no_delay(true), ignored);
      device().connected(SimulatedDevice::Time::clock::now());
      read(client_);
      attend();
      accept();
    });
  }

  void dropClient() {
    error_code ignored;
    if (client_) client_->socket.close(ignored);
    client_.reset();
  }

  void read(const std::shared_ptr<Client>& client) {
    client->socket.async_read_some(asio::buffer(client->incoming),
                                   [this, alive = alive_, client](const error_code& error, std::size_t count) {
                                     if (!*alive || client != client_) return;
                                     if (error) return dropClient();
                                     take(std::string_view(client->incoming.data(), count));
                                     if (client == client_) read(client);
                                   });
  }

  void writeOn(const std::shared_ptr<Client>& client) {
    client->outgoing = std::exchange(client->waiting, {});
    if (client->outgoing.empty()) return;
    asio::async_write(client->socket, asio::buffer(client->outgoing),
                      [this, alive = alive_, client](const error_code& error, std::size_t) {
                        if (!*alive || client != client_) return;
                        client->outgoing.clear();
                        if (error) return dropClient();
                        writeOn(client);
                        if (client->ends && client->outgoing.empty()) dropClient();
                      });
  }

  asio::io_context& context_;
  std::string host_;
  int port_;
  std::shared_ptr<bool> alive_;  // handlers may come after this has gone
  std::unique_ptr<tcp::acceptor> acceptor_;
  std::shared_ptr<Client> client_;
};

}  // namespace

std::unique_ptr<HostPort> makeTcpPort(asio::io_context& context, std::unique_ptr<SimulatedDevice> device,
                                      std::string host, int port) {
  return std::make_unique<TcpPort>(context, std::move(device), std::move(host), port);
}

}  // namespace pixelflex::devices
