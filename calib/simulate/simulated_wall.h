#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "calib/simulate/rig.h"
#include "devices/camera/camera.h"
#include "devices/camera/operator.h"
#include "devices/image/image.h"
#include "devices/projector/projector.h"

namespace pixelflex::calib {

/// Ray geometry of a screen. It has one side: from behind it is neither lit nor seen.
class Screen {
 public:
  Screen() = default;
  virtual ~Screen() = default;
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  /// Where a ray from `origin` along `direction` meets the screen, in room coordinates; none when it misses.
  [[nodiscard]] virtual std::optional<glm::dvec3> hit(glm::dvec3 origin, glm::dvec3 direction) const = 0;
  [[nodiscard]] virtual glm::dvec2 wallFromRoom(glm::dvec3 point) const = 0;
  [[nodiscard]] virtual glm::dvec3 roomFromWall(glm::dvec2 pointInWall) const = 0;
  [[nodiscard]] virtual glm::dvec3 normal(glm::dvec2 pointInWall) const = 0;  // unit, towards the audience
  /// Whether nothing of the screen stands between a point of the room and the audience's side of a point of the wall.
  [[nodiscard]] virtual bool isVisible(glm::dvec3 from, glm::dvec2 pointInWall) const = 0;
};

/// A room with a screen, projectors, a camera and a person, computed physically: frames become linear radiance on the
/// screen (response, vignetting, lit area, defocus, leak), add up, and the camera integrates them (ambient light,
/// exposure, point spread, shot and read noise, quantisation). It shares no distortion or homography code with the
/// estimators. Deterministic for a rig's seed and the sequence of photographs. Thread-bound.
class SimulatedWall {
 public:
  explicit SimulatedWall(const Rig& rig) : SimulatedWall(rig, rig) {}
  /// `reference`: the same room with its projectors set otherwise. Radiance, ambient light and the camera's exposure
  /// are counted as there, so that photographs of both compare.
  SimulatedWall(Rig rig, const Rig& reference);
  ~SimulatedWall();
  SimulatedWall(const SimulatedWall&) = delete;
  SimulatedWall& operator=(const SimulatedWall&) = delete;

  [[nodiscard]] const Rig& rig() const;

  /// The devices; they live as long as the wall.
  [[nodiscard]] devices::Camera& camera();
  [[nodiscard]] std::size_t projectorCount() const;
  [[nodiscard]] devices::Projector& projector(std::size_t index);
  [[nodiscard]] devices::Operator& person();
  /// How many places the person can move the camera to: the rig's camera pose and its further places.
  [[nodiscard]] int placeCount() const;

  // Ground truth, for tests and for what the audience sees; never for calibration.

  /// Where the light of a projector's point lands; none when it misses the screen's surface.
  [[nodiscard]] std::optional<glm::dvec2> wallFromProjector(std::size_t index, glm::dvec2 pointInProjector) const;
  [[nodiscard]] std::optional<glm::dvec2> projectorFromWall(std::size_t index, glm::dvec2 pointInWall) const;
  /// For the camera at one of its places, wherever it stands now; also outside the picture.
  [[nodiscard]] std::optional<glm::dvec2> cameraFromWall(glm::dvec2 pointInWall, int place = 0) const;
  /// Linear light of one projector per device code, relative: response, gain and leak of a channel.
  [[nodiscard]] double light(std::size_t index, int channel, double code01) const;
  /// Radiance on the wall of a projector's full white at a point of its frame, relative to the rig's brightest.
  [[nodiscard]] double radiance(std::size_t index, glm::dvec2 pointInProjector) const;

  /// The light that comes from a rectangle of the wall to somebody straight in front of it, for measuring: relative
  /// radiance (1: the rig's brightest) in red, green and blue, its mean over each pixel, of a white screen without
  /// markers or ambient light. All projectors show `frames` (same order; an empty or missing image is black, which
  /// leaks). The next call for the same rectangle and size is quicker.
  [[nodiscard]] devices::ImageF audienceLight(const std::vector<devices::Image8>& frames, glm::dvec2 topLeft,
                                              glm::dvec2 bottomRight, devices::Size size) const;

  /// What the audience sees, straight on, sRGB: the wall rectangle from topLeft to bottomRight at `size`, all
  /// projectors showing `frames` (same order; an empty image is black). Exposed so that `white` (relative radiance;
  /// 0: chosen from the rig) becomes 255.
  [[nodiscard]] devices::Image8 audience(const std::vector<devices::Image8>& frames, glm::dvec2 topLeft,
                                         glm::dvec2 bottomRight, devices::Size size, double white = 0) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pixelflex::calib
