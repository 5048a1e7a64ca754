#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "viewer/vnc/link_tuner.h"
#include "viewer/vnc/rfb_client.h"
#include "viewer/vnc/session.h"

namespace pixelflex::viewer {

/// Keeps the settings of one connection as its user wants them or, if that is left to it, as the connection is. On the
/// session's thread.
class LinkWatch {
 public:
  /// `socket` is connected; both must outlive this.
  LinkWatch(int socket, const SessionOptions& options);

  /// What to begin with.
  [[nodiscard]] LinkSettings settings() const;

  /// Around each message of the server: `waiting` is how long its bytes were waited for.
  void before();
  /// Asks for other settings when it is time; the words for people then.
  [[nodiscard]] std::optional<std::string> after(RfbClient& client, std::chrono::nanoseconds waiting);

 private:
  [[nodiscard]] LinkSettings settingsOf(LinkSettings settings) const;
  [[nodiscard]] std::chrono::nanoseconds roundTrip(const RfbClient& client) const;
  [[nodiscard]] std::string describe(const RfbClient& client) const;

  int socket_;
  const SessionOptions& options_;
  std::optional<LinkTuner> tuner_;
  LinkSettings fixed_;  // without a tuner
  std::uint64_t bytesBefore_ = 0;
  std::chrono::steady_clock::time_point pinged_;
};

}  // namespace pixelflex::viewer
