#include "devices/transport/line_loop.h"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <future>

namespace pixelflex::devices {

struct LineLoop::Work {
  explicit Work(boost::asio::io_context& context) : guard(context.get_executor()) {}
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> guard;
};

LineLoop::LineLoop()
    : context_(std::make_unique<boost::asio::io_context>(1)),
      work_(std::make_unique<Work>(*context_)),
      thread_([this] { context_->run(); }) {}

LineLoop::~LineLoop() {
  work_.reset();
  context_->stop();
  thread_.join();
}

void LineLoop::invoke(const std::function<void()>& action) {
  if (isOwnThread()) {
    action();
    return;
  }
  const auto task = std::make_shared<std::packaged_task<void()>>(action);
  auto done = task->get_future();
  boost::asio::post(*context_, [task] { (*task)(); });
  done.get();
}

}  // namespace pixelflex::devices
