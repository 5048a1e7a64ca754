#pragma once

#include <functional>
#include <memory>
#include <thread>

namespace boost::asio {
class io_context;
}

namespace pixelflex::devices {

/// The one thread on which any number of lines do their input and output. It must outlive its lines.
class LineLoop {
 public:
  LineLoop();
  ~LineLoop();
  LineLoop(const LineLoop&) = delete;
  LineLoop& operator=(const LineLoop&) = delete;

  [[nodiscard]] boost::asio::io_context& context() { return *context_; }
  [[nodiscard]] bool isOwnThread() const { return std::this_thread::get_id() == thread_.get_id(); }
  /// Runs `action` on the loop's thread and returns when it has ended; what it throws is thrown here.
  void invoke(const std::function<void()>& action);

 private:
  struct Work;
  std::unique_ptr<boost::asio::io_context> context_;
  std::unique_ptr<Work> work_;
  std::thread thread_;
};

}  // namespace pixelflex::devices
