#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "devices/image/image.h"
#include "viewer/vnc/session.h"

namespace pixelflex::testing {

/// A source whose batches are put together to a desktop in memory, as a renderer would: what the tests compare with
/// the X server's own screen.
class DesktopMirror {
 public:
  using Make = std::function<std::unique_ptr<viewer::DesktopSource>(viewer::FrameBelt&, std::function<void()> wake)>;
  explicit DesktopMirror(const Make& make);
  explicit DesktopMirror(viewer::SessionOptions options);
  /// Connects to an address as users write it.
  explicit DesktopMirror(const std::string& address);

  [[nodiscard]] viewer::DesktopSource& session() { return *session_; }

  /// Takes whatever has arrived, until `done` or `timeout`; says whether `done` came true. `done` is asked whenever
  /// something arrived and at least every 50 ms.
  bool pumpUntil(const std::function<bool()>& done, std::chrono::milliseconds timeout = std::chrono::seconds(20));
  /// Takes whatever arrives during `time`.
  void pumpFor(std::chrono::milliseconds time);
  /// Takes what arrives until nothing has for `quiet`; false if that never comes.
  bool pumpUntilStill(std::chrono::milliseconds quiet = std::chrono::milliseconds(300),
                      std::chrono::milliseconds timeout = std::chrono::seconds(20));
  /// Waits until the desktop is equal to the screen of the X server, bit for bit.
  bool pumpUntilEqual(const std::string& display, std::chrono::milliseconds timeout = std::chrono::seconds(60));

  /// As of the last completed update: red, green, blue. Empty before the first.
  [[nodiscard]] const devices::Image8& desktop() const { return desktop_; }
  [[nodiscard]] const std::vector<viewer::SessionEvent>& events() const { return events_; }
  [[nodiscard]] std::uint64_t updates() const { return updates_; }
  [[nodiscard]] std::uint64_t batches() const { return batches_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// What has arrived, for the message of a failed test.
  [[nodiscard]] std::string summary() const;

  /// The last event of a kind, if there was one.
  template <class Kind>
  [[nodiscard]] std::optional<Kind> last() const {
    for (auto event = events_.rbegin(); event != events_.rend(); ++event) {
      if (const Kind* found = std::get_if<Kind>(&*event)) return *found;
    }
    return std::nullopt;
  }

 private:
  void wake();
  void takeAll();
  void apply(const viewer::Batch& batch);

  std::mutex mutex_;
  std::condition_variable arrived_;
  bool pending_ = false;
  viewer::FrameBelt belt_;
  devices::Image8 desktop_;
  std::vector<viewer::SessionEvent> events_;
  std::uint64_t updates_ = 0;
  std::uint64_t batches_ = 0;
  std::uint64_t bytes_ = 0;
  std::unique_ptr<viewer::DesktopSource> session_;
};

}  // namespace pixelflex::testing
