#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "devices/image/image.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// What a process holds.
struct Held {
  std::ptrdiff_t descriptors = 0;
  double megabytes = 0;  // of resident memory
};

/// `pixelflex view --headless` on a flat wall of one screen, with a log.
class ViewerRun {
 public:
  /// Starts it; throws std::runtime_error.
  ViewerRun(devices::Size screen, const std::string& server, std::vector<std::string> more);

  [[nodiscard]] Process& process() { return *process_; }
  [[nodiscard]] std::string log() const;
  [[nodiscard]] Held held() const;

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Process> process_;
};

}  // namespace pixelflex::testing
