#include "viewer/programs/password.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <span>
#include <string_view>

#include "viewer/programs/private_file.h"
#include "viewer/vnc/vnc_auth.h"
#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {
namespace {

constexpr const char* kEnvironment = "PIXELFLEX_VNC_PASSWORD";
constexpr const char* kWhat = "password";

bool isText(std::string_view bytes) {
  return std::ranges::none_of(bytes, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < ' ' || byte >= 0x7f;
  });
}

// Switches the terminal's echo off while it lives.
class SilentTerminal {
 public:
  explicit SilentTerminal(int terminal) : terminal_(terminal), known_(::tcgetattr(terminal, &before_) == 0) {
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    if (known_) ::tcsetattr(terminal_, TCSAFLUSH, &silent);
  }
  ~SilentTerminal() {
    if (known_) ::tcsetattr(terminal_, TCSAFLUSH, &before_);
  }
  SilentTerminal(const SilentTerminal&) = delete;
  SilentTerminal& operator=(const SilentTerminal&) = delete;

  [[nodiscard]] bool silent() const { return known_; }

 private:
  int terminal_;
  termios before_{};
  bool known_;
};

void say(int terminal, std::string_view text) {
  [[maybe_unused]] const ssize_t written = ::write(terminal, text.data(), text.size());
}

sigset_t blockedQuitSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

// A terminal gives a line at a time. Nothing when the program is told to quit, so that the echo comes back on first.
Secret readLine(int terminal) {
  const sigset_t signals = blockedQuitSignals();
  const FileDescriptor quit(::signalfd(-1, &signals, SFD_CLOEXEC));
  std::array<pollfd, 2> watched{{{terminal, POLLIN, 0}, {quit.get(), POLLIN, 0}}};
  while (::poll(watched.data(), watched.size(), -1) < 0 && errno == EINTR) {
  }
  if (watched[1].revents != 0) return {};
  std::array<char, 1024> line{};
  const ssize_t got = ::read(terminal, line.data(), line.size());
  std::string_view typed(line.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
  while (typed.ends_with('\n')) typed.remove_suffix(1);
  Secret text(typed);
  wipe(line);
  return text;
}

}  // namespace

Secret readPasswordFile(const std::string& file) {
  const Secret text = readPrivateFile(file, kWhat);
  constexpr std::size_t kHidden = 8;
  if (text.size() == kHidden && !isText(text.text().substr(0, text.text().find('\n')))) {
    std::array<std::uint8_t, kHidden> hidden{};
    std::ranges::copy(text.text(), hidden.begin());
    return revealVncPassword(hidden);
  }
  return readPrivateLine(file, kWhat);
}

std::optional<Secret> takePasswordOfEnvironment() {
  char* const value = std::getenv(kEnvironment);
  if (value == nullptr) return std::nullopt;
  const std::span<char> bytes(value, std::string_view(value).size());
  Secret password(std::string_view(bytes.data(), bytes.size()));
  wipe(bytes);  // as long as the process lives, the kernel shows what it was started with
  ::unsetenv(kEnvironment);
  return password;
}

std::optional<Secret> askForPassword(const std::string& question) {
  const FileDescriptor terminal(::open("/dev/tty", O_RDWR | O_CLOEXEC | O_NOCTTY));
  // A program in the background would be stopped for asking.
  if (terminal.get() < 0 || ::tcgetpgrp(terminal.get()) != ::getpgrp()) return std::nullopt;
  const SilentTerminal silence(terminal.get());
  if (!silence.silent()) return std::nullopt;
  say(terminal.get(), question);
  Secret password = readLine(terminal.get());
  say(terminal.get(), "\n");
  return password.empty() ? std::nullopt : std::optional(std::move(password));
}

}  // namespace pixelflex::viewer
