#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "devices/control/device.h"
#include "viewer/control/device_command.h"

namespace pixelflex::viewer {

class ConsoleBoard;

/// Steps for one device and who wants to know that they are done.
struct DeviceTask {
  std::string text;  // of the steps, for people
  std::vector<DeviceStep> steps;
  /// Called once, from any thread: what went wrong, or an empty text.
  std::function<void(const std::string& error)> done;
};

/// One device of a console: does what it is given in turn, and in between reads what the device is set to. All waiting
/// is done on threads of its own. Thread-safe.
class DeviceWorker {
 public:
  /// Writes to `board`, which must outlive it, about its device number `index`.
  DeviceWorker(ConsoleBoard& board, std::size_t index, std::shared_ptr<devices::Device> device,
               std::chrono::milliseconds pollEvery);
  /// Stops what is under way and waits for that. A mirror that was moved is halted.
  ~DeviceWorker();
  DeviceWorker(const DeviceWorker&) = delete;
  DeviceWorker& operator=(const DeviceWorker&) = delete;

  /// A task that finds too many waiting is done at once, with an error that says so.
  void give(DeviceTask task);
  /// So many wait that it takes no more, as refusal() says.
  [[nodiscard]] bool isFull();
  [[nodiscard]] std::string refusal() const;
  /// What waits is dropped, what is under way is stopped, and the device halts; at once, also in the midst of a move.
  /// `done` as a task's.
  void halt(std::function<void(const std::string& error)> done);
  /// Drops and stops as halt() does, without waiting for the end: for several workers that are to end at a time.
  void retire();
  /// Reads everything anew soon.
  void lookAgain();

  [[nodiscard]] const std::shared_ptr<devices::Device>& device() const { return device_; }

  /// It has done what somebody else asked of device(): what it refused before is no trouble any more. Any thread.
  void succeeded();

 private:
  void work(const std::stop_token& stop);
  void haltWhenAsked(const std::stop_token& stop);
  void run(const DeviceTask& task);
  void readBack(const std::vector<DeviceStep>& steps);
  void poll(const std::stop_token& stop);
  struct Reading;
  void readAll(const std::stop_token& stop);
  [[nodiscard]] std::string read(const std::string& setting);
  [[nodiscard]] std::string valueBefore(const std::string& setting) const;
  /// A device that takes long is shown before it is `whole`.
  void show(const Reading& reading, bool whole);
  [[nodiscard]] bool hasTasks();
  [[nodiscard]] std::vector<DeviceTask> dropTasks();
  void failed(const std::string& why);
  void showWaiting();

  ConsoleBoard& board_;
  std::size_t index_;
  std::shared_ptr<devices::Device> device_;
  std::chrono::milliseconds pollEvery_;

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<DeviceTask> tasks_;
  std::vector<std::function<void(const std::string& error)>> halts_;
  std::stop_source running_;  // of the task under way
  bool look_ = true;
  bool lost_ = false;  // of the worker's own thread

  std::jthread halter_;
  std::jthread worker_;
};

}  // namespace pixelflex::viewer
