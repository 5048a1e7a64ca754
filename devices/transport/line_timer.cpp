#include "devices/transport/line_timer.h"

#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <utility>

namespace pixelflex::devices {

struct LineTimer::State {
  explicit State(boost::asio::io_context& context) : timer(context) {}
  boost::asio::steady_timer timer;
  std::uint64_t number = 0;  // a call that was queued before a cancellation must not come after it
};

LineTimer::LineTimer(boost::asio::io_context& context) : state_(std::make_shared<State>(context)) {}

LineTimer::~LineTimer() {
  cancel();
}

void LineTimer::setAt(std::chrono::steady_clock::time_point time, std::function<void()> call) {
  const auto number = ++state_->number;
  state_->timer.expires_at(time);
  state_->timer.async_wait([state = state_, number, call = std::move(call)](const boost::system::error_code& error) {
    if (!error && state->number == number) call();
  });
}

void LineTimer::set(std::chrono::milliseconds delay, std::function<void()> call) {
  setAt(std::chrono::steady_clock::now() + delay, std::move(call));
}

void LineTimer::cancel() {
  ++state_->number;
  state_->timer.cancel();
}

}  // namespace pixelflex::devices
