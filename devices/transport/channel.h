#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "devices/transport/line_address.h"

namespace boost::asio {
class io_context;
}

namespace pixelflex::devices {

/// A stream of bytes to one device, for one connection: opened once, closed once. Lives and calls back on the loop's
/// thread. After its destructor nothing calls back any more.
class Channel {
 public:
  struct Events {
    std::function<void()> opened;
    std::function<void(std::string_view bytes)> received;
    /// Before or after it was opened; at most once. `why` is a clause such as "connection refused".
    std::function<void(const std::string& why)> closed;
  };
  Channel() = default;
  virtual ~Channel() = default;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// Returns at once; the outcome is an event. May call back before it returns.
  virtual void open(Events events) = 0;
  virtual void write(std::string bytes) = 0;
  /// Whether something written has not left yet.
  [[nodiscard]] virtual bool isWriting() const = 0;
};

[[nodiscard]] std::unique_ptr<Channel> makeChannel(boost::asio::io_context& context, const LineAddress& address);

}  // namespace pixelflex::devices
