#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "devices/transport/channel.h"
#include "devices/transport/line.h"

namespace pixelflex::devices {

class LineTimer;

/// What a Line does on the loop's thread. Public members other than the atomics belong to that thread.
class Line::Engine : public std::enable_shared_from_this<Engine> {
 public:
  Engine(boost::asio::io_context& context, LineAddress address, LineOptions options);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  void enqueue(Exchange exchange, std::function<void(Answer)> done);
  void disconnect();
  /// For good.
  void shut();

  [[nodiscard]] std::string name() const;
  [[nodiscard]] const LineAddress& address() const { return address_; }
  [[nodiscard]] boost::asio::io_context& context() { return context_; }

  std::atomic<std::uint64_t> sessions{0};
  std::atomic<bool> connected{false};

 private:
  enum class State {
    kDown,      // no connection; the timer may be running towards the attempt that somebody waits for
    kOpening,   // the timer ends the attempt
    kReady,     // the timer may be running towards the end of the gap
    kAwaiting,  // a reply; the timer is its deadline
    kEmptying,  // bytes are dropped until the line is quiet
  };
  struct Pending {
    Exchange exchange;
    std::function<void(Answer)> done;
  };

  void pump();
  void open();
  void connectionFailed(const std::string& why);
  void connectionLost(const std::string& why);
  void pauseBeforeNext();
  void dropChannel();
  void send();
  void receive(std::string_view bytes);
  void tryReply();
  void deadlinePassed();
  void breakOff(const LineProblem& problem);
  void empty();
  void awaitQuiet();
  void interrupt();
  void finish(Answer answer);
  void failAll(LineFailure failure, const std::string& message);

  boost::asio::io_context& context_;
  LineAddress address_;
  LineOptions options_;
  std::unique_ptr<LineTimer> timer_;
  std::unique_ptr<Channel> channel_;
  std::uint64_t channelNumber_ = 0;  // events of earlier channels are not heard
  State state_ = State::kDown;
  std::deque<Pending> queue_;  // its front is under way in kAwaiting
  std::string received_;
  std::chrono::steady_clock::time_point earliestSend_{};
  std::chrono::steady_clock::time_point emptyBy_{};
  std::chrono::steady_clock::time_point earliestOpen_{};
  std::chrono::milliseconds pause_{0};
  int silences_ = 0;
  bool emptyNext_ = false;  // a reply that nobody waits for may still come
  bool shut_ = false;
};

}  // namespace pixelflex::devices
