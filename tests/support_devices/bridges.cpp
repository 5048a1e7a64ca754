#include "tests/support_devices/bridges.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/free_port.h"

namespace pixelflex::testing {
namespace {

/// Without knocking: a bridge would open its device for that, beside the connection that is meant.
bool isListening(int port) {
  std::array<char, 16> place{};
  (void)std::snprintf(place.data(), place.size(), ":%04X ", static_cast<unsigned>(port));
  std::ifstream table("/proc/net/tcp");
  for (std::string line; std::getline(table, line);) {
    const auto at = line.find(place.data());
    const bool listens = line.find(" 0A ") != std::string::npos;
    if (listens && at != std::string::npos && at < line.find(" 0A ")) return true;
  }
  return false;
}

std::string ser2netSettings(Bridge::Kind kind, int port, const std::string& device) {
  const std::string accepter = kind == Bridge::Kind::kSer2netRaw ? "tcp" : "telnet(rfc2217),tcp";
  return "connection: &line\n  accepter: " + accepter + ",127.0.0.1," + std::to_string(port) +
         "\n  connector: serialdev(nouucplock=true)," + device + ",9600n81,local\n  options: {kickolduser: true}\n";
}

}  // namespace

void waitForPort(int port) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!isListening(port)) {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("nothing listens");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

Bridge::Bridge(Kind kind, const std::string& serialDevice) : kind_(kind), port_(freePort()) {
  std::vector<std::string> command;
  if (kind == Kind::kSocat) {
    // Two connections at one device, the old one lingering, would share what it says.
    command = {"socat", "-t0", "TCP-LISTEN:" + std::to_string(port_) + ",bind=127.0.0.1,reuseaddr,fork",
               "FILE:" + serialDevice + ",b9600,raw,echo=0"};
  } else {
    const auto settings = folder_ / "ser2net.yaml";
    std::ofstream(settings) << ser2netSettings(kind, port_, serialDevice);
    command = {"/usr/sbin/ser2net", "-n", "-d", "-c", settings.string(), "-P", (folder_ / "pid").string()};
  }
  process_ = std::make_unique<Process>(command, ProcessOptions{.log = folder_ / "log"});
  waitForPort(port_);
}

std::string Bridge::address() const {
  const std::string scheme = kind_ == Kind::kSer2netRfc2217 ? "rfc2217" : "tcp";
  return scheme + "://127.0.0.1:" + std::to_string(port_);
}

}  // namespace pixelflex::testing
