#pragma once

#include <string>

#include "viewer/model/scene.h"

namespace pixelflex::viewer {

/// From process to process through a descriptor: whole scenes, or what became of them. Both ends are the same program.
/// Throw ModelError when the other end is gone.
void sendScene(int descriptor, const Scene& scene);
void sendFailure(int descriptor, const std::string& message);
/// What was sent; a failure comes out as ModelError.
[[nodiscard]] Scene receiveScene(int descriptor);

/// The other process ended before it had sent everything.
class SenderGone : public ModelError {
 public:
  SenderGone() : ModelError("the reader of the model ended early") {}
};

}  // namespace pixelflex::viewer
