#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/image/image.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// An X server without hardware (Xvfb or Xvnc) on a display number that it chooses itself, so that any number of tests
/// may run at once. Ready for clients when the constructor returns. Throws std::runtime_error with the server's last
/// words when it does not start.
class XServer {
 public:
  /// Builds the command for one attempt to start (another follows when a port was snatched away). -displayfd is added.
  using Command = std::function<std::vector<std::string>(const TemporaryFolder& folder)>;
  explicit XServer(const Command& command);

  /// Like ":7".
  [[nodiscard]] const std::string& display() const { return display_; }
  /// Starts an X client on this display; it lives at most as long as the server.
  Process& start(const std::vector<std::string>& command);
  /// Runs an X client to its end and returns what it printed. Throws std::runtime_error when it fails.
  std::string query(const std::vector<std::string>& command) const;
  [[nodiscard]] Process& process() { return *server_; }
  [[nodiscard]] const TemporaryFolder& folder() const { return folder_; }

 private:
  bool tryToStart(const Command& command);

  TemporaryFolder folder_;
  std::unique_ptr<Process> server_;
  std::string display_;
  std::vector<std::unique_ptr<Process>> clients_;
};

struct XvncOptions {
  devices::Size size{1024, 768};
  bool unixSocket = true;
  bool tcp = false;
  std::optional<std::string> password;  // empty: everybody may connect
  std::vector<std::string> more;        // further arguments
};

/// TigerVNC's server, depth 24.
class XvncServer {
 public:
  explicit XvncServer(const XvncOptions& options = {});

  [[nodiscard]] XServer& x() { return *x_; }
  /// As users write it: "unix:PATH". Empty without `unixSocket`.
  [[nodiscard]] const std::string& unixAddress() const { return unixAddress_; }
  /// "127.0.0.1::PORT". Empty without `tcp`.
  [[nodiscard]] const std::string& tcpAddress() const { return tcpAddress_; }

 private:
  std::string unixAddress_;
  std::string tcpAddress_;
  std::unique_ptr<XServer> x_;
};

/// Xvfb, depth 24, shown by x11vnc on a TCP port of 127.0.0.1.
class X11vncServer {
 public:
  explicit X11vncServer(devices::Size size);

  [[nodiscard]] XServer& x() { return x_; }
  [[nodiscard]] const std::string& tcpAddress() const { return tcpAddress_; }

 private:
  XServer x_;
  std::unique_ptr<Process> x11vnc_;
  std::string tcpAddress_;
};

/// Fills the root window with noise, which no codec makes small.
void paintNoise(const std::string& display, unsigned seed);

/// How many keys are down, as the X server knows it.
[[nodiscard]] std::size_t keysDown(const std::string& display);

/// The whole screen as the X server itself holds it, without the pointer: red, green, blue.
[[nodiscard]] devices::Image8 grabRoot(const std::string& display);

}  // namespace pixelflex::testing
