#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "viewer/control/console_board.h"

namespace pixelflex::viewer {

/// What a long job sees of its console.
struct JobView {
  ConsoleBoard& board;
  int number;
  std::stop_token stop;

  void tell(const std::string& state, std::optional<double> part = std::nullopt) const;
  /// A line that the same command would print.
  void say(const std::string& line) const;
};

/// Jobs of which there is one at a time, on a thread of its own. Thread-safe.
class LongJob {
 public:
  /// `board` must outlive it.
  explicit LongJob(ConsoleBoard& board) : board_(board) {}
  /// Stops the one that runs and waits for its end.
  ~LongJob();
  LongJob(const LongJob&) = delete;
  LongJob& operator=(const LongJob&) = delete;

  /// What `action` throws ends the job as its error. Returns the job's number. Throws std::runtime_error while another
  /// one runs.
  int start(ConsoleJob::Kind kind, const std::string& command, std::function<void(const JobView& view)> action);
  /// The one of this number stops as soon as it can; any other is left alone.
  void cancel(int job);
  /// The one that runs, whatever its number, if it is of this kind.
  void cancel(ConsoleJob::Kind kind);

 private:
  ConsoleBoard& board_;
  std::mutex mutex_;
  int number_ = 0;
  ConsoleJob::Kind kind_ = ConsoleJob::Kind::kPreset;
  std::string command_;
  bool running_ = false;
  std::jthread thread_;
};

}  // namespace pixelflex::viewer
