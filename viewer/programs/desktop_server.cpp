#include "viewer/programs/desktop_server.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "viewer/programs/desktop_command.h"

namespace pixelflex::viewer {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kStartTimeout{60};
constexpr const char* kLogName = "server.log";
constexpr std::size_t kRoomForSocket = 16;  // its name in the folder

fs::path placeForFolder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const fs::path place = runtime == nullptr ? "" : runtime;
  const bool good = place.is_absolute() && ::access(place.c_str(), W_OK | X_OK) == 0;
  constexpr std::string_view kName = "/pixelflex-XXXXXX";
  const bool fits = place.string().size() + kName.size() + kRoomForSocket < sizeof(sockaddr_un::sun_path);
  return good && fits ? place : fs::path("/tmp");
}

void appendCounted(std::string& record, std::string_view bytes) {
  record += static_cast<char>(bytes.size() >> 8);
  record += static_cast<char>(bytes.size() & 0xFF);
  record += bytes;
}

std::string xvncProgram() {
  for (const auto* name : {"Xtigervnc", "Xvnc"}) {
    if (findProgram(name)) return name;
  }
  throw std::runtime_error("Xvnc is not installed: apt install tigervnc-standalone-server");
}

}  // namespace

PrivateFolder::PrivateFolder() {
  std::string pattern = (placeForFolder() / "pixelflex-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    throw std::system_error(errno, std::generic_category(), "cannot make a folder like " + pattern);
  }
  path_ = pattern;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

DesktopServer::DesktopServer(Household& household, devices::Size size, const std::string& name) {
  const std::string program = xvncProgram();
  writeCookies();
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
  const std::string geometry = std::to_string(size.width) + "x" + std::to_string(size.height);
  pid_ = household.start({program,
                          "-displayfd",
                          std::to_string(ends[1]),
                          "-geometry",
                          geometry,
                          "-depth",
                          "24",
                          "-desktop",
                          name,
                          "-auth",
                          cookies(),
                          "-nolisten",
                          "tcp",
                          "-rfbport",
                          "-1",
                          "-rfbunixpath",
                          socket(),
                          "-rfbunixmode",
                          "0600",
                          "-SecurityTypes",
                          "None",
                          "-FrameRate",
                          "60",
                          "-AcceptSetDesktopSize=1",
                          "-AlwaysShared",
                          "-noreset"},
                         {.log = folder_.path() / kLogName, .inheritedFd = ends[1]});
  ::close(ends[1]);
  waitForDisplay(household, ends[0]);
  ::close(ends[0]);
}

// One record that fits whatever number the display will have: FamilyWild, no address, no number.
void DesktopServer::writeCookies() const {
  std::array<char, 16> cookie{};
  if (::getrandom(cookie.data(), cookie.size(), 0) != static_cast<ssize_t>(cookie.size())) {
    throw std::system_error(errno, std::generic_category(), "getrandom");
  }
  std::string record = "\xFF\xFF";
  for (const std::string_view part : {"", "", "MIT-MAGIC-COOKIE-1"}) appendCounted(record, part);
  appendCounted(record, {cookie.data(), cookie.size()});
  const mode_t mask = ::umask(0077);
  std::ofstream(cookies(), std::ios::binary) << record;
  ::umask(mask);
}

// It writes its number and a line end once it takes clients.
void DesktopServer::waitForDisplay(Household& household, int pipe) {
  const auto deadline = Clock::now() + kStartTimeout;
  ::fcntl(pipe, F_SETFL, O_NONBLOCK);
  std::string text;
  while (!text.ends_with('\n')) {
    const auto event = household.wait(std::chrono::milliseconds(1000), pipe);
    if (event.quit) return;
    std::array<char, 16> part{};
    const ssize_t got = ::read(pipe, part.data(), part.size());
    if (got > 0) text.append(part.data(), static_cast<std::size_t>(got));
    if (household.statusOf(pid_)) throw std::runtime_error("Xvnc does not start: " + lastWords());
    if (Clock::now() > deadline) throw std::runtime_error("Xvnc does not get ready: " + lastWords());
  }
  display_ = ":" + text.substr(0, text.size() - 1);
}

std::string DesktopServer::lastWords() const {
  std::ifstream log(folder_.path() / kLogName);
  std::string last = "it says nothing";
  for (std::string line; std::getline(log, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace pixelflex::viewer
