#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <utility>

#include "devices/simulate/simulators.h"
#include "devices/transport/channels.h"
#include "devices/transport/line_timer.h"

namespace pixelflex::devices {
namespace {

using Clock = std::chrono::steady_clock;

class SimulatedChannel : public Channel {
 public:
  SimulatedChannel(boost::asio::io_context& context, const LineAddress& address)
      : device_(makeSimulator(address.simulator)), timer_(context) {}

  void open(Events events) override {
    events_ = std::move(events);
    timer_.setAt(Clock::now(), [this] {
      if (device_->suffers(Fault::kCut)) return events_.closed("the simulated line is cut");
      device_->connected(Clock::now());
      schedule();
      events_.opened();
    });
  }

  void write(std::string bytes) override {
    device_->receive(bytes, Clock::now());
    schedule();
  }
  [[nodiscard]] bool isWriting() const override { return false; }

 private:
  void schedule() {
    if (const auto due = device_->nextDue()) timer_.setAt(*due, [this] { hand(); });
  }

  void hand() {
    const std::string bytes = device_->take(Clock::now());
    const bool ends = device_->wantsClose();
    schedule();
    if (!bytes.empty()) events_.received(bytes);
    if (ends) events_.closed("the other end closed it");
  }

  std::unique_ptr<SimulatedDevice> device_;
  Events events_;
  LineTimer timer_;
};

}  // namespace

std::unique_ptr<Channel> makeSimulatedChannel(boost::asio::io_context& context, const LineAddress& address) {
  return std::make_unique<SimulatedChannel>(context, address);
}

}  // namespace pixelflex::devices
