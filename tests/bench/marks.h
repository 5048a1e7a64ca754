#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "devices/image/size.h"

namespace pixelflex::testing {

/// A drawing X client and what became of its drawings: boxes of 64x64 pixels, each of a colour of its own, at places
/// that take turns, so that a box is seen long after the next one was drawn.
class Marks {
 public:
  using Clock = std::chrono::steady_clock;
  /// The colour that a viewer shows at a pixel of the desktop.
  using Look = std::function<std::uint32_t(glm::ivec2)>;

  Marks(const std::string& display, devices::Size desktop);
  ~Marks();
  Marks(const Marks&) = delete;
  Marks& operator=(const Marks&) = delete;

  /// Draws the next one and notes when.
  void draw();
  /// Takes note of those that are seen, in order. Any thread.
  void look(const Look& look);
  /// All were seen.
  [[nodiscard]] bool allSeen() const;
  /// The last one drawn: its upper left pixel and its colour.
  [[nodiscard]] glm::ivec2 lastPlace() const { return placeOf(drawn_ - 1); }
  [[nodiscard]] std::uint32_t lastColour() const { return colourOf(drawn_ - 1); }
  /// Milliseconds from the drawing of each to the sight of it, since the last call; those not seen are forgotten.
  [[nodiscard]] std::vector<double> take();

 private:
  struct X;
  struct Mark {
    std::uint64_t number = 0;
    Clock::time_point drawn;
  };
  [[nodiscard]] glm::ivec2 placeOf(std::uint64_t number) const;
  [[nodiscard]] static std::uint32_t colourOf(std::uint64_t number);

  std::unique_ptr<X> x_;
  devices::Size desktop_;
  std::uint64_t drawn_ = 0;
  mutable std::mutex mutex_;
  std::deque<Mark> waiting_;
  std::vector<double> milliseconds_;
};

}  // namespace pixelflex::testing
