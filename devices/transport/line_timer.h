#pragma once

#include <chrono>
#include <functional>
#include <memory>

namespace boost::asio {
class io_context;
}

namespace pixelflex::devices {

/// Calls once, later, on the loop's thread; setting it again or cancelling it forgets the call before.
class LineTimer {
 public:
  explicit LineTimer(boost::asio::io_context& context);
  ~LineTimer();
  LineTimer(const LineTimer&) = delete;
  LineTimer& operator=(const LineTimer&) = delete;
  void setAt(std::chrono::steady_clock::time_point time, std::function<void()> call);
  void set(std::chrono::milliseconds delay, std::function<void()> call);
  void cancel();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace pixelflex::devices
