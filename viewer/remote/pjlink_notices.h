#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/remote/listen_address.h"

namespace pixelflex::devices {
class LineLoop;
}

namespace pixelflex::viewer {

struct PjlinkNoticesOptions {
  ListenAddress at;                        // where searches are heard; broadcasts only at 0.0.0.0
  std::vector<ListenAddress> listeners;    // who hears of changes
  std::string hardware;                    // "02:00:5e:10:00:01", what tells devices apart
  std::chrono::milliseconds latest{3000};  // searches are answered at a random time before
  std::chrono::milliseconds every{250};    // how often changes are looked for
};

/// PJLink over UDP (class 2) on a loop's thread: answers searches, and tells listeners that the link is up and how
/// power, input and errors change.
class PjlinkNotices {
 public:
  /// The answer to a query such as "POWR". Called on the loop's thread.
  using Ask = std::function<std::string(std::string_view body)>;

  /// `loop` must outlive it. Throws std::runtime_error when the port is taken.
  PjlinkNotices(devices::LineLoop& loop, const PjlinkNoticesOptions& options, Ask ask);
  /// Not on the loop's thread. No call of `ask` goes on after it.
  ~PjlinkNotices();
  PjlinkNotices(const PjlinkNotices&) = delete;
  PjlinkNotices& operator=(const PjlinkNotices&) = delete;

 private:
  struct Core;
  devices::LineLoop& loop_;
  std::shared_ptr<Core> core_;
};

/// Of this machine's first network interface that has one; one made of its name where there is none.
[[nodiscard]] std::string hardwareAddress();

}  // namespace pixelflex::viewer
