#pragma once

#include <atomic>
#include <glm/vec2.hpp>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace pixelflex::testing {

/// A paint program: a white window over a whole X screen in which the pointer, while its left button is held, draws in
/// black.
class PaintClient {
 public:
  explicit PaintClient(const std::string& display);
  ~PaintClient();
  PaintClient(const PaintClient&) = delete;
  PaintClient& operator=(const PaintClient&) = delete;

  /// For each stroke the places of the pointer from press to release.
  [[nodiscard]] std::vector<std::vector<glm::ivec2>> strokes() const;

 private:
  void run(const std::string& display);

  mutable std::mutex mutex_;
  std::vector<std::vector<glm::ivec2>> strokes_;
  std::atomic<bool> ready_ = false;
  std::jthread thread_;
};

}  // namespace pixelflex::testing
