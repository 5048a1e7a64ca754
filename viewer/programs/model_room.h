#pragma once

#include <filesystem>
#include <vector>

#include "viewer/plan/model_wall.h"
#include "viewer/programs/room_of_rig.h"

namespace pixelflex::viewer {

/// What the audience of a simulated wall sees of a model. One thread, the context's, which must outlive it and share
/// with the model's.
class ModelRoom {
 public:
  /// `projectors` shine, numbers as of WallPlan::projectors(). Throws PlanError, StoreError.
  ModelRoom(devices::GlContext& context, const WallPlan& wall, const std::filesystem::path& folder,
            std::vector<std::size_t> projectors);

  /// A picture `width` pixels wide that shows just the screen.
  [[nodiscard]] devices::Size sizeFor(int width) const;
  /// Nothing for an empty size.
  void draw(const ModelWall& model, devices::Size size);
  [[nodiscard]] devices::GlName texture() const { return room_.texture(); }
  [[nodiscard]] devices::Image8 read() { return room_.read(); }
  /// Of the picture drawn last.
  [[nodiscard]] const RoomFraming& framing() const { return framing_; }

 private:
  ModelRoom(devices::GlContext& context, const RoomOfRig& rig, std::vector<std::size_t> projectors);

  std::vector<std::size_t> projectors_;
  RoomFraming framing_;
  RoomView room_;
};

}  // namespace pixelflex::viewer
