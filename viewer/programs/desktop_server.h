#pragma once

#include <filesystem>
#include <string>

#include "devices/image/size.h"
#include "viewer/programs/desktop_household.h"

namespace pixelflex::viewer {

/// A folder that nobody else may look into, in XDG_RUNTIME_DIR where there is one; removed with its contents.
class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// TigerVNC's X server with a cookie of its own, reached by its UNIX socket and nothing else.
class DesktopServer {
 public:
  /// Ready for clients when the constructor returns. Throws std::runtime_error with its last words when it does not
  /// start, or which package has it.
  DesktopServer(Household& household, devices::Size size, const std::string& name);

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Like ":7".
  [[nodiscard]] const std::string& display() const { return display_; }
  [[nodiscard]] std::filesystem::path socket() const { return folder_.path() / "vnc.sock"; }
  [[nodiscard]] std::filesystem::path cookies() const { return folder_.path() / "Xauthority"; }
  /// The last line that it wrote.
  [[nodiscard]] std::string lastWords() const;
  /// Interrupted by a signal to quit before it was ready.
  [[nodiscard]] bool interrupted() const { return display_.empty(); }

 private:
  void writeCookies() const;
  void waitForDisplay(Household& household, int pipe);

  PrivateFolder folder_;
  pid_t pid_ = -1;
  std::string display_;
};

}  // namespace pixelflex::viewer
