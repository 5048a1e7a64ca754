#include "viewer/x11/same_desktop.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

namespace fs = std::filesystem;
using Inodes = std::set<std::uint64_t>;
using Processes = std::set<std::string>;

constexpr std::string_view kXSockets = "/tmp/.X11-unix/X";
constexpr unsigned kAccepts = 0x10000;  // the kernel's __SO_ACCEPTCON
constexpr std::string_view kTcpListens = "0A";
constexpr std::chrono::seconds kPatience{2};

struct UnixListener {
  std::uint64_t inode = 0;
  std::string name;  // of an abstract one without its zero
};

std::vector<UnixListener> unixListeners() {
  std::vector<UnixListener> listeners;
  std::ifstream table("/proc/net/unix");
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string number, references, protocol, type, state;
    unsigned flags = 0;
    UnixListener listener;
    words >> number >> references >> protocol >> std::hex >> flags >> std::dec >> type >> state >> listener.inode;
    if (!words || (flags & kAccepts) == 0) continue;
    std::getline(words >> std::ws, listener.name);
    if (listener.name.starts_with('@')) listener.name.erase(0, 1);
    listeners.push_back(std::move(listener));
  }
  return listeners;
}

// Whatever the address: who asks for this port here may get any of them.
Inodes tcpListeners(int port) {
  Inodes inodes;
  for (const char* file : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream table(file);
    for (std::string line; std::getline(table, line);) {
      std::istringstream words(line);
      std::string number, local, remote, state, skipped;
      words >> number >> local >> remote >> state;
      std::uint64_t inode = 0;
      words >> skipped >> skipped >> skipped >> skipped >> skipped >> inode;
      const std::size_t colon = local.find(':');
      if (!words || state != kTcpListens || colon == std::string::npos) continue;
      if (std::stoi(local.substr(colon + 1), nullptr, 16) == port) inodes.insert(inode);
    }
  }
  return inodes;
}

bool isThisMachine(const std::string& host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

Inodes listenersAt(const ServerAddress& server) {
  if (!server.isUnixSocket()) return isThisMachine(server.host) ? tcpListeners(server.port) : Inodes{};
  std::error_code ignored;
  const fs::path path = fs::weakly_canonical(server.socketPath, ignored);
  Inodes inodes;
  for (const UnixListener& listener : unixListeners()) {
    const fs::path name = listener.name;
    if (name.is_absolute() && fs::weakly_canonical(name, ignored) == path) inodes.insert(listener.inode);
  }
  return inodes;
}

// The sockets that a process has open; none when it may not be looked into.
Inodes socketsOf(const std::string& process) {
  constexpr std::string_view kSocket = "socket:[";
  Inodes inodes;
  std::error_code error;
  for (fs::directory_iterator entry("/proc/" + process + "/fd", error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code gone;
    const std::string target = fs::read_symlink(*entry, gone).string();
    if (!gone && target.starts_with(kSocket)) inodes.insert(std::stoull(target.substr(kSocket.size())));
  }
  return inodes;
}

Processes processesWithAny(const Inodes& wanted) {
  Processes found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const Inodes open = socketsOf(name);
    if (std::ranges::any_of(wanted, [&open](std::uint64_t inode) { return open.contains(inode); })) found.insert(name);
  }
  return found;
}

std::set<int> displaysOf(const Inodes& open) {
  std::set<int> displays;
  for (const UnixListener& listener : unixListeners()) {
    if (!open.contains(listener.inode) || !listener.name.starts_with(kXSockets)) continue;
    const std::string digits = listener.name.substr(kXSockets.size());
    displays.insert(parseXDisplay(digits).number);
  }
  return displays;
}

bool letsUsIn(const XDisplay& display) {
  const Signal never;
  try {
    const FileDescriptor socket = connectToDisplay(display);
    requireWelcome(display, socket.get(), cookieFor(display), std::chrono::steady_clock::now() + kPatience, never);
    return true;
  } catch (const SessionError&) {
    return false;
  }
}

}  // namespace

std::optional<XDisplay> displayBehind(const ServerAddress& server) {
  const Inodes listeners = listenersAt(server);
  if (listeners.empty()) return std::nullopt;
  const Processes processes = processesWithAny(listeners);
  if (processes.size() != 1) return std::nullopt;
  const Inodes open = socketsOf(*processes.begin());
  // Another user's process may listen there, too.
  if (!std::ranges::includes(open, listeners)) return std::nullopt;
  const std::set<int> displays = displaysOf(open);
  if (displays.size() != 1) return std::nullopt;
  const XDisplay display{*displays.begin(), 0};
  return letsUsIn(display) ? std::optional(display) : std::nullopt;
}

}  // namespace pixelflex::viewer
