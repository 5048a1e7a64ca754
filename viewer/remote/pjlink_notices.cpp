#include "viewer/remote/pjlink_notices.h"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

#include "devices/transport/line_loop.h"

namespace pixelflex::viewer {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

// A flood of searches, perhaps with forged senders, is not answered with a flood.
constexpr int kMostPending = 16;

udp::endpoint endpointOf(const ListenAddress& at) {
  return {asio::ip::make_address(at.host), at.port};
}

/// Of what a listener hears: that power changes, not how far it is.
std::string told(std::string_view body, const std::string& answer) {
  if (body != "POWR") return answer;
  if (answer == "1" || answer == "3") return "1";
  return answer == "0" || answer == "2" ? "0" : answer;
}

}  // namespace

struct PjlinkNotices::Core : std::enable_shared_from_this<PjlinkNotices::Core> {
  Core(asio::io_context& context, PjlinkNoticesOptions noticesOptions, Ask asker)
      : options(std::move(noticesOptions)), ask(std::move(asker)), socket(context), timer(context) {}

  void open() {
    const udp::endpoint place = endpointOf(options.at);
    socket.open(place.protocol());
    socket.bind(place);
    receive();
    if (options.listeners.empty()) return;
    tell("LKUP", options.hardware);
    watch();
  }

  void receive() {
    socket.async_receive_from(asio::buffer(incoming), sender,
                              [core = shared_from_this()](const error_code& error, std::size_t count) {
                                if (!core->ask || error == asio::error::operation_aborted) return;
                                // Errors are of what was sent before: somebody is not there.
                                if (!error && isSearch({core->incoming.data(), count})) core->answerLater();
                                core->receive();
                              });
  }

  static bool isSearch(std::string_view text) { return text == "%2SRCH\r" || text == "%2srch\r"; }

  void answerLater() {
    if (pending >= kMostPending) return;
    ++pending;
    std::uniform_int_distribution<std::chrono::milliseconds::rep> delay(0, options.latest.count());
    auto wait = std::make_shared<asio::steady_timer>(timer.get_executor(), std::chrono::milliseconds(delay(random)));
    wait->async_wait([core = shared_from_this(), wait, to = sender](const error_code&) {
      --core->pending;
      if (core->ask) core->send("%2ACKN=" + core->options.hardware + "\r", to);
    });
  }

  void watch() {
    timer.expires_after(options.every);
    timer.async_wait([core = shared_from_this()](const error_code&) {
      if (!core->ask) return;
      core->tellChanges();
      core->watch();
    });
  }

  /// What is known for the first time has changed, too; what cannot be told now, such as the input of a wall that is
  /// off, has not.
  void tellChanges() {
    for (const auto* body : {"POWR", "ERST", "INPT"}) {
      const std::string now = told(body, ask(body));
      if (now.starts_with("ERR") || known[body] == now) continue;
      known[body] = now;
      tell(body, now);
    }
  }

  void tell(std::string_view body, const std::string& value) {
    for (const auto& listener : options.listeners) {
      send("%2" + std::string(body) + "=" + value + "\r", endpointOf(listener));
    }
  }

  /// What cannot be sent is lost, as on a network.
  void send(const std::string& text, const udp::endpoint& to) {
    error_code ignored;
    socket.send_to(asio::buffer(text), to, udp::socket::message_flags(), ignored);
  }

  void close() {
    ask = nullptr;
    error_code ignored;
    socket.close(ignored);
    timer.cancel(ignored);
  }

  PjlinkNoticesOptions options;
  Ask ask;
  udp::socket socket;
  asio::steady_timer timer;
  std::array<char, 64> incoming{};
  udp::endpoint sender;
  int pending = 0;
  std::map<std::string, std::string> known;  // what was told last, by body
  std::minstd_rand random{std::random_device()()};
};

PjlinkNotices::PjlinkNotices(devices::LineLoop& loop, const PjlinkNoticesOptions& options, Ask ask)
    : loop_(loop), core_(std::make_shared<Core>(loop.context(), options, std::move(ask))) {
  try {
    loop_.invoke([this] { core_->open(); });
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error("searches for PJLink cannot be heard at " + options.at.text() +
                             " (UDP): " + error.code().message());
  }
}

PjlinkNotices::~PjlinkNotices() {
  loop_.invoke([this] { core_->close(); });
}

}  // namespace pixelflex::viewer
