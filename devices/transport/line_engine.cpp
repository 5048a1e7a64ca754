#include "devices/transport/line_engine.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cassert>
#include <utility>

#include "devices/transport/line_timer.h"

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostWaiting = 64;
constexpr std::size_t kLongestReply = 16384;
constexpr milliseconds kFirstPause{200};
constexpr milliseconds kLongestPause{1000};
constexpr milliseconds kLongestEmptying{2000};
// In a row: the connection may be dead without a word of it.
constexpr int kMostSilences = 2;

}  // namespace

Line::Engine::Engine(boost::asio::io_context& context, LineAddress address, LineOptions options)
    : context_(context),
      address_(std::move(address)),
      options_(std::move(options)),
      timer_(std::make_unique<LineTimer>(context)) {}

Line::Engine::~Engine() = default;

std::string Line::Engine::name() const {
  return options_.device.empty() ? address_.text() : options_.device + " at " + address_.text();
}

void Line::Engine::enqueue(Exchange exchange, std::function<void(Answer)> done) {
  if (shut_) return done(LineProblem{LineFailure::kInterrupted, name() + ": the line is closed"});
  const bool urgent = exchange.urgent;
  if (queue_.size() >= kMostWaiting && !urgent) {
    return done(LineProblem{LineFailure::kCrowded, name() + ": too many requests wait already"});
  }
  // One that is urgent goes behind the other urgent ones.
  auto place = queue_.end();
  if (urgent) {
    if (state_ == State::kAwaiting && !queue_.front().exchange.urgent) interrupt();
    place = std::ranges::find_if(queue_, [](const Pending& pending) { return !pending.exchange.urgent; });
  }
  queue_.insert(place, {std::move(exchange), std::move(done)});
  pump();
}

/// The next step, if the state has one to take.
void Line::Engine::pump() {
  if (shut_ || queue_.empty()) return;
  if (state_ == State::kDown) return timer_->setAt(earliestOpen_, [this] { open(); });
  if (state_ != State::kReady) return;
  const bool waits = Clock::now() < earliestSend_ && !queue_.front().exchange.urgent;
  if (!waits) return send();
  timer_->setAt(earliestSend_, [this] { pump(); });
}

void Line::Engine::open() {
  state_ = State::kOpening;
  received_.clear();
  const auto number = ++channelNumber_;
  const auto mine = [this, number] { return number == channelNumber_; };
  timer_->set(options_.connectTimeout, [this] { connectionFailed("no answer"); });
  try {
    channel_ = makeChannel(context_, address_);
  } catch (const std::exception& error) {
    return connectionFailed(error.what());
  }
  channel_->open({[this, mine] {
                    if (!mine()) return;
                    state_ = State::kReady;
                    timer_->cancel();
                    pause_ = milliseconds(0);
                    connected = true;
                    ++sessions;
                    pump();
                  },
                  [this, mine](std::string_view bytes) {
                    if (mine()) receive(bytes);
                  },
                  [this, mine](const std::string& why) {
                    if (mine()) state_ == State::kOpening ? connectionFailed(why) : connectionLost(why);
                  }});
}

void Line::Engine::connectionFailed(const std::string& why) {
  dropChannel();
  pauseBeforeNext();
  failAll(LineFailure::kUnreachable, name() + ": no connection: " + why);
}

void Line::Engine::connectionLost(const std::string& why) {
  dropChannel();
  pauseBeforeNext();
  failAll(LineFailure::kLost, name() + ": the connection was lost: " + why);
}

/// Each failure in a row makes the next attempt wait longer.
void Line::Engine::pauseBeforeNext() {
  pause_ = std::clamp(pause_ * 2, kFirstPause, kLongestPause);
  earliestOpen_ = Clock::now() + pause_;
}

/// Without destroying the channel here: it may be the one that calls.
void Line::Engine::dropChannel() {
  ++channelNumber_;
  state_ = State::kDown;
  silences_ = 0;
  connected = false;
  emptyNext_ = false;
  timer_->cancel();
  if (!channel_) return;
  boost::asio::post(context_, [old = std::shared_ptr<Channel>(std::move(channel_))] {});
}

void Line::Engine::send() {
  const Exchange& exchange = queue_.front().exchange;
  if (!exchange.keepEarlier) received_.clear();
  if (!exchange.bytes.empty()) channel_->write(exchange.bytes);
  state_ = State::kAwaiting;
  timer_->set(exchange.timeout, [this] { deadlinePassed(); });
  if (!exchange.end) return finish(std::string());
  if (exchange.keepEarlier) tryReply();
}

void Line::Engine::receive(std::string_view bytes) {
  if (state_ == State::kEmptying) {
    if (Clock::now() > emptyBy_) return connectionLost("it goes on talking without being asked; is that its speed?");
    return awaitQuiet();
  }
  received_ += bytes;
  if (received_.size() > kLongestReply) {
    if (state_ == State::kAwaiting) return connectionLost("it talks without an end; is that its speed?");
    received_.erase(0, received_.size() - kLongestReply);
  }
  if (state_ == State::kAwaiting) tryReply();
}

void Line::Engine::tryReply() {
  const auto size = queue_.front().exchange.end(received_);
  if (!size) return;
  assert(*size <= received_.size());
  silences_ = 0;
  std::string reply = received_.substr(0, *size);
  received_.erase(0, *size);
  finish(std::move(reply));
}

void Line::Engine::finish(Answer answer) {
  const auto done = std::move(queue_.front().done);
  queue_.pop_front();
  timer_->cancel();
  earliestSend_ = Clock::now() + options_.gap;
  if (std::exchange(emptyNext_, false)) {
    empty();
  } else {
    state_ = State::kReady;
  }
  done(std::move(answer));
  pump();
  const bool rests = state_ == State::kReady && queue_.empty() && options_.idleClose.count() > 0;
  if (rests) timer_->set(options_.idleClose, [this] { disconnect(); });
}

void Line::Engine::deadlinePassed() {
  const bool stuck = channel_->isWriting();
  std::string message = name() + ": no reply";
  if (!received_.empty()) message = name() + ": the reply was cut short";
  if (stuck) message = name() + ": the request does not leave";
  const LineProblem problem{LineFailure::kSilent, message + "; is it switched on, and is that its speed?"};
  if (!stuck && ++silences_ < kMostSilences) return breakOff(problem);
  // Those behind it go to another connection.
  const auto done = std::move(queue_.front().done);
  queue_.pop_front();
  dropChannel();
  pauseBeforeNext();
  done(problem);
  pump();
}

void Line::Engine::breakOff(const LineProblem& problem) {
  emptyNext_ = true;
  if (!options_.resync.empty()) channel_->write(options_.resync);
  finish(problem);
}

void Line::Engine::empty() {
  state_ = State::kEmptying;
  received_.clear();
  emptyBy_ = Clock::now() + kLongestEmptying;
  awaitQuiet();
}

void Line::Engine::awaitQuiet() {
  timer_->set(options_.quiet, [this] {
    state_ = State::kReady;
    pump();
  });
}

/// What is under way makes room: its reply may still come and is dropped.
void Line::Engine::interrupt() {
  const auto done = std::move(queue_.front().done);
  queue_.pop_front();
  timer_->cancel();
  received_.clear();
  state_ = State::kReady;
  emptyNext_ = true;
  done(LineProblem{LineFailure::kInterrupted, name() + ": broken off by an urgent request"});
}

void Line::Engine::failAll(LineFailure failure, const std::string& message) {
  // The answers may ask again.
  for (auto& pending : std::exchange(queue_, {})) pending.done(LineProblem{failure, message});
}

void Line::Engine::disconnect() {
  if (shut_) return;
  dropChannel();
  earliestOpen_ = {};
  failAll(LineFailure::kInterrupted, name() + ": the line was closed");
}

void Line::Engine::shut() {
  disconnect();
  shut_ = true;
}

}  // namespace pixelflex::devices
