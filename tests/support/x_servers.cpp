#include "tests/support/x_servers.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "tests/support/free_port.h"

namespace pixelflex::testing {
namespace {

constexpr int kAttempts = 3;
constexpr std::chrono::seconds kStartTimeout{20};
constexpr const char* kLogName = "server.log";

std::string readText(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string geometry(devices::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

// What the server writes once it is ready: its display number and a line end. Empty when it closed the pipe or time is
// up.
std::string readDisplayNumber(int fd) {
  std::string text;
  while (!text.ends_with('\n')) {
    pollfd watched{fd, POLLIN, 0};
    std::array<char, 16> part{};
    if (::poll(&watched, 1, std::chrono::milliseconds(kStartTimeout).count()) <= 0) return {};
    const ssize_t got = ::read(fd, part.data(), part.size());
    if (got <= 0) return {};
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  text.pop_back();
  return text;
}

// In VNC's own format, which x11vnc and Xvnc share.
void writePassword(const std::filesystem::path& path, const std::string& password) {
  const Output output = run({"x11vnc", "-storepasswd", password, path.string()});
  if (output.status != 0) throw std::runtime_error("x11vnc -storepasswd: " + output.text);
}

std::vector<std::string> xvncCommand(const XvncOptions& options, const TemporaryFolder& folder, int port) {
  std::vector<std::string> command{"Xtigervnc",     "-geometry", geometry(options.size), "-depth",    "24",
                                   "-AlwaysShared", "-rfbport",  std::to_string(port),   "-nolisten", "tcp"};
  if (options.unixSocket) command.insert(command.end(), {"-rfbunixpath", (folder / "vnc.sock").string()});
  if (options.tcp) command.push_back("-localhost");
  if (options.password) {
    const std::filesystem::path file = folder / "password";
    writePassword(file, *options.password);
    command.insert(command.end(), {"-SecurityTypes", "VncAuth", "-PasswordFile", file.string()});
  } else {
    command.insert(command.end(), {"-SecurityTypes", "None"});
  }
  command.insert(command.end(), options.more.begin(), options.more.end());
  return command;
}

std::vector<std::string> xvfbCommand(devices::Size size) {
  return {"Xvfb", "-screen", "0", geometry(size) + "x24", "-nolisten", "tcp"};
}

// x11vnc writes "PORT=N" into its flag file when it is ready.
int waitForPort(Process& process, const std::filesystem::path& flag) {
  const auto deadline = std::chrono::steady_clock::now() + kStartTimeout;
  while (std::chrono::steady_clock::now() < deadline && process.running()) {
    const std::string text = readText(flag);
    if (text.starts_with("PORT=") && text.ends_with('\n')) return std::stoi(text.substr(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error("x11vnc did not start");
}

// Clients take letters for what the locale says.
std::vector<std::string> clientEnvironment(const std::string& display) {
  return {"DISPLAY=" + display, "LC_ALL=C.UTF-8"};
}

}  // namespace

XServer::XServer(const Command& command) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (tryToStart(command)) return;
  }
  throw std::runtime_error("the X server does not start; it says: " + readText(folder_ / kLogName));
}

bool XServer::tryToStart(const Command& command) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
  std::vector<std::string> arguments = command(folder_);
  arguments.insert(arguments.end(), {"-displayfd", std::to_string(ends[1])});
  server_ = std::make_unique<Process>(arguments, ProcessOptions{{}, folder_ / kLogName, ends[1]});
  ::close(ends[1]);
  const std::string number = readDisplayNumber(ends[0]);
  ::close(ends[0]);
  display_ = ":" + number;
  return !number.empty();
}

Process& XServer::start(const std::vector<std::string>& command) {
  clients_.push_back(
      std::make_unique<Process>(command, ProcessOptions{clientEnvironment(display_), folder_ / "clients.log"}));
  return *clients_.back();
}

std::string XServer::query(const std::vector<std::string>& command) const {
  Output output = run(command, clientEnvironment(display_));
  if (output.status != 0) throw std::runtime_error(command.front() + " failed: " + output.text);
  return std::move(output.text);
}

XvncServer::XvncServer(const XvncOptions& options) {
  int port = -1;
  x_ = std::make_unique<XServer>([&](const TemporaryFolder& folder) {
    port = options.tcp ? freePort() : -1;
    return xvncCommand(options, folder, port);
  });
  if (options.unixSocket) unixAddress_ = "unix:" + (x_->folder() / "vnc.sock").string();
  if (options.tcp) tcpAddress_ = "127.0.0.1::" + std::to_string(port);
}

X11vncServer::X11vncServer(devices::Size size) : x_([size](const TemporaryFolder&) { return xvfbCommand(size); }) {
  const std::filesystem::path flag = x_.folder() / "x11vnc.port";
  const std::vector<std::string> command{
      "x11vnc", "-display",    x_.display(), "-localhost", "-autoport", std::to_string(freePort()),
      "-flag",  flag.string(), "-forever",   "-shared",    "-nopw",     "-norc",
      "-quiet"};
  x11vnc_ = std::make_unique<Process>(command, ProcessOptions{{}, x_.folder() / "x11vnc.log"});
  tcpAddress_ = "127.0.0.1::" + std::to_string(waitForPort(*x11vnc_, flag));
}

}  // namespace pixelflex::testing
