#include "devices/display/gamma_keeper.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xcb/randr.h>
#include <xcb/xcb.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

#include "devices/display/display_error.h"

namespace pixelflex::devices {
namespace {

/// More than any hardware has; a message of three tables stays far below what a socket holds.
constexpr std::uint32_t kMostEntries = 4096;

/// Followed, where there are entries, by the tables of red, green and blue: then they are to be set.
struct Request {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::uint32_t entries = 0;
};

struct Message {
  Request request;
  std::array<std::uint16_t, 3 * std::size_t{kMostEntries}> tables;
};

std::size_t bytesOf(const Request& request) {
  return sizeof(Request) + 3 * sizeof(std::uint16_t) * std::size_t{request.entries};
}

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};
template <class Reply>
std::unique_ptr<Reply, Free> owned(Reply* reply) {
  return std::unique_ptr<Reply, Free>(reply);
}

/// The keeping process's own connection to the display.
class Outputs {
 public:
  explicit Outputs(const char* display) : x_(xcb_connect(display, nullptr)) {
    if (xcb_connection_has_error(x_) != 0) return;
    std::free(xcb_randr_query_version_reply(x_, xcb_randr_query_version(x_, 1, 5), nullptr));
  }
  ~Outputs() {
    for (const auto& [crtc, tables] : before_) (void)write(crtc, tables.data(), tables.size() / 3);
    xcb_disconnect(x_);
  }
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// The entries of the output's table; 0: it has none, or would not take it.
  std::uint32_t serve(const Message& message) {
    const Request& request = message.request;
    const auto crtc = find(request);
    if (!crtc) return 0;
    const std::uint32_t entries = entriesOf(*crtc);
    if (request.entries == 0 || request.entries != entries) return request.entries == 0 ? entries : 0;
    if (!before_.contains(*crtc)) {
      auto tables = read(*crtc);
      // What could not be given back is not set.
      if (tables.size() != 3 * std::size_t{entries}) return 0;
      before_[*crtc] = std::move(tables);
    }
    return write(*crtc, message.tables.data(), entries) ? entries : 0;
  }

 private:
  [[nodiscard]] std::optional<xcb_randr_crtc_t> find(const Request& wanted) const {
    if (xcb_connection_has_error(x_) != 0) return std::nullopt;
    for (auto roots = xcb_setup_roots_iterator(xcb_get_setup(x_)); roots.rem > 0; xcb_screen_next(&roots)) {
      const auto ask = xcb_randr_get_screen_resources_current(x_, roots.data->root);
      const auto all = owned(xcb_randr_get_screen_resources_current_reply(x_, ask, nullptr));
      if (all == nullptr) continue;
      const auto* crtcs = xcb_randr_get_screen_resources_current_crtcs(all.get());
      for (int i = 0; i < all->num_crtcs; ++i) {
        if (shows(crtcs[i], wanted)) return crtcs[i];
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] bool shows(xcb_randr_crtc_t crtc, const Request& wanted) const {
    const auto info =
        owned(xcb_randr_get_crtc_info_reply(x_, xcb_randr_get_crtc_info(x_, crtc, XCB_CURRENT_TIME), nullptr));
    return info != nullptr && info->mode != XCB_NONE && info->x == wanted.x && info->y == wanted.y &&
           info->width == wanted.width && info->height == wanted.height;
  }

  [[nodiscard]] std::uint32_t entriesOf(xcb_randr_crtc_t crtc) const {
    const auto size = owned(xcb_randr_get_crtc_gamma_size_reply(x_, xcb_randr_get_crtc_gamma_size(x_, crtc), nullptr));
    return size == nullptr || size->size < 2 || size->size > kMostEntries ? 0 : size->size;
  }

  [[nodiscard]] std::vector<std::uint16_t> read(xcb_randr_crtc_t crtc) const {
    const auto reply = owned(xcb_randr_get_crtc_gamma_reply(x_, xcb_randr_get_crtc_gamma(x_, crtc), nullptr));
    std::vector<std::uint16_t> tables;
    if (reply == nullptr) return tables;
    for (const auto* channel : {xcb_randr_get_crtc_gamma_red(reply.get()), xcb_randr_get_crtc_gamma_green(reply.get()),
                                xcb_randr_get_crtc_gamma_blue(reply.get())}) {
      tables.insert(tables.end(), channel, channel + reply->size);
    }
    return tables;
  }

  [[nodiscard]] bool write(xcb_randr_crtc_t crtc, const std::uint16_t* tables, std::size_t entries) const {
    const auto cookie = xcb_randr_set_crtc_gamma_checked(x_, crtc, static_cast<std::uint16_t>(entries), tables,
                                                         tables + entries, tables + 2 * entries);
    return owned(xcb_request_check(x_, cookie)) == nullptr && xcb_connection_has_error(x_) == 0;
  }

  xcb_connection_t* x_;
  std::map<xcb_randr_crtc_t, std::vector<std::uint16_t>> before_;  // red, green and blue in a row
};

/// Out of reach of what ends the other: its signals, its terminal, its descriptors.
[[noreturn]] void keep(int socket, const std::optional<std::string>& display) {
  ::setsid();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(number, SIG_IGN);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, descriptor);
  {
    std::optional<Outputs> outputs;
    Message message{};
    while (true) {
      const ssize_t count = ::recv(socket, &message, sizeof message, 0);
      if (count < 0 && errno == EINTR) continue;
      if (count < static_cast<ssize_t>(sizeof(Request))) break;
      if (!outputs) outputs.emplace(display ? display->c_str() : nullptr);
      const std::uint32_t answer = outputs->serve(message);
      (void)!::send(socket, &answer, sizeof answer, MSG_NOSIGNAL);
    }
  }
  ::_exit(0);
}

Request requestFor(glm::ivec2 topLeft, Size size) {
  return {.x = topLeft.x, .y = topLeft.y, .width = size.width, .height = size.height};
}

}  // namespace

GammaKeeper::GammaKeeper(std::optional<std::string> display) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  socket_ = ends[0];
  child_ = ::fork();
  if (child_ < 0) {
    const int error = errno;
    for (const int end : ends) ::close(end);
    throw std::system_error(error, std::generic_category(), "fork");
  }
  if (child_ == 0) {
    ::close(ends[0]);
    keep(ends[1], display);
  }
  ::close(ends[1]);
}

GammaKeeper::~GammaKeeper() {
  ::close(socket_);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) continue;
}

std::size_t GammaKeeper::ask(const void* request, std::size_t bytes) {
  std::uint32_t answer = 0;
  if (::send(socket_, request, bytes, MSG_NOSIGNAL) != static_cast<ssize_t>(bytes)) return 0;
  ssize_t count = 0;
  do {
    count = ::recv(socket_, &answer, sizeof answer, 0);
  } while (count < 0 && errno == EINTR);
  return count == static_cast<ssize_t>(sizeof answer) ? answer : 0;
}

std::size_t GammaKeeper::entriesAt(glm::ivec2 topLeft, Size size) {
  const Request request = requestFor(topLeft, size);
  return ask(&request, bytesOf(request));
}

void GammaKeeper::set(glm::ivec2 topLeft, Size size, const GammaRamp& ramp) {
  const auto message = std::make_unique<Message>();
  message->request = requestFor(topLeft, size);
  const std::size_t entries = ramp[0].size();
  if (entries >= 2 && entries <= kMostEntries && ramp[1].size() == entries && ramp[2].size() == entries) {
    message->request.entries = static_cast<std::uint32_t>(entries);
    for (std::size_t c = 0; c < 3; ++c) {
      std::ranges::copy(ramp[c], message->tables.begin() + static_cast<std::ptrdiff_t>(c * entries));
    }
    if (ask(message.get(), bytesOf(message->request)) == entries) return;
  }
  throw DisplayError(fmt::format("the output of {}x{} pixels at {},{} does not take a look-up table of {} entries",
                                 size.width, size.height, topLeft.x, topLeft.y, entries));
}

}  // namespace pixelflex::devices
