#pragma once

namespace pixelflex::devices {

/// What a person at the wall is asked to arrange before a photograph.
enum class Scene {
  kRoomLight,     // lights on, markers visible, projectors black
  kDark,          // lights out: only the projectors shine
  kCheckerboard,  // lights on, the checkerboard held up in its next pose
};

/// The person at the wall (or what stands for them, on a simulated wall).
class Operator {
 public:
  Operator() = default;
  virtual ~Operator() = default;
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;

  /// Returns when the scene is ready and the camera exposed for it. For kCheckerboard `index` counts the poses from 0.
  /// Returns false when the person has no more to show (enough checkerboard poses).
  [[nodiscard]] virtual bool arrange(Scene scene, int index) = 0;

  /// Returns when the camera stands at its next place, counted from 0: a wall that one photograph cannot hold is
  /// photographed from several. False: there is no such place.
  [[nodiscard]] virtual bool placeCamera(int place) { return place == 0; }
};

}  // namespace pixelflex::devices
