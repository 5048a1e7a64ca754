#include "viewer/programs/display_viewers.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "viewer/programs/projector_windows.h"
#include "viewer/programs/quit_signal.h"
#include "viewer/programs/wall_view.h"

namespace pixelflex::viewer {
namespace {

constexpr int kPasswordStatus = 77;  // exit status of a viewer that needs one

std::string serverOf(const std::string& display) {
  const auto dot = display.find('.', std::min(display.rfind(':'), display.size()));
  return display.substr(0, dot);
}

/// Screen 0 is the one that is meant when none is named.
std::string plainName(const std::string& display) {
  return display.ends_with(".0") ? serverOf(display) : display;
}

std::string usualDisplay() {
  const char* const usual = std::getenv("DISPLAY");
  return plainName(usual == nullptr ? "" : usual);
}

/// What is there once for the wall, or once for an X server, is left to the first viewer there.
ViewOptions optionsFor(const DisplayShare& share, bool first, bool firstOfServer, ViewOptions options) {
  options.projectors = share.projectors;
  if (!firstOfServer) options.clipboardLimit = 0;
  if (first) return options;
  options.control = false;
  options.resize = Resize::kNo;
  options.statsJson.reset();
  return options;
}

/// In the new process: never returns.
[[noreturn]] void become(const DisplayShare& share, const ViewOptions& options, pid_t parent,
                         const std::function<int(const ViewOptions&)>& view) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  int status = 1;
  try {
    ::setenv("DISPLAY", share.display.c_str(), 1);
    if (::getppid() == parent) status = view(options);
  } catch (const PasswordNeeded&) {
    status = kPasswordStatus;
  } catch (const std::exception& error) {
    fmt::print(stderr, "pixelflex-view: on display {}: {}\n", share.display, error.what());
  }
  std::fflush(nullptr);
  ::_exit(status);
}

/// The processes, by their number.
class Viewers {
 public:
  void start(const DisplayShare& share, const ViewOptions& options,
             const std::function<int(const ViewOptions&)>& view) {
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process == 0) become(share, options, parent, view);
    if (process < 0) throw ViewError("cannot start a viewer for display " + share.display);
    displays_[process] = share.display;
  }
  void endAll() {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
    for (const auto& [process, display] : displays_) ::kill(process, SIGTERM);
  }
  /// Waits for the next that ends: its status.
  int waitForOne() {
    siginfo_t ended{};
    while (::waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT) != 0) {
    }
    const std::scoped_lock lock(mutex_);
    int status = 0;
    ::waitpid(ended.si_pid, &status, 0);
    const auto display = displays_.extract(ended.si_pid);
    const int result = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    const bool missed = result != 0 && result != kPasswordStatus && !ending_ && !displays_.empty();
    if (missed) fmt::print(stderr, "pixelflex-view: display {} is dark, the others go on\n", display.mapped());
    return result;
  }
  [[nodiscard]] bool any() const { return !displays_.empty(); }

 private:
  std::mutex mutex_;  // the signals' thread ends them all
  bool ending_ = false;
  std::map<pid_t, std::string> displays_;
};

}  // namespace

std::vector<DisplayShare> sharesOfDisplays(const WallPlan& wall) {
  std::vector<DisplayShare> shares;
  std::set<std::string> named;
  for (const auto* projector : wall.projectors()) {
    const auto& output = configOf(wall, projector->name).output;
    if (output.kind == calib::OutputKind::kNone) continue;
    const bool byDisplay = output.kind == calib::OutputKind::kDisplay;
    const std::string display = byDisplay ? plainName(output.display) : usualDisplay();
    if (byDisplay) named.insert(display);
    auto share = std::ranges::find(shares, display, &DisplayShare::display);
    if (share == shares.end()) share = shares.insert(shares.end(), {display, {}});
    share->projectors.push_back(projector->name);
  }
  if (named.size() < 2) return {};
  std::stable_partition(shares.begin(), shares.end(),
                        [](const DisplayShare& share) { return share.display == usualDisplay(); });
  return shares;
}

int runViewers(const ViewOptions& options, const std::vector<DisplayShare>& shares,
               const std::function<int(const ViewOptions&)>& view) {
  Viewers viewers;
  std::set<std::string> servers;
  for (const DisplayShare& share : shares) {
    const bool first = servers.empty();
    const bool firstOfServer = servers.insert(serverOf(share.display)).second;
    viewers.start(share, optionsFor(share, first, firstOfServer, options), view);
  }
  const QuitSignal signal([&viewers] { viewers.endAll(); });
  bool passwordNeeded = false;
  int worst = 0;
  bool ended = false;
  while (viewers.any()) {
    const int status = viewers.waitForOne();
    passwordNeeded = passwordNeeded || status == kPasswordStatus;
    ended = ended || status == 0;
    worst = std::max(worst, status);
    // Each writes its own screenshots.
    if (status == kPasswordStatus || (status == 0 && !options.screenshot)) viewers.endAll();
  }
  if (passwordNeeded) throw PasswordNeeded("the server asks for a password");
  return ended && !options.screenshot ? 0 : worst;
}

}  // namespace pixelflex::viewer
