#pragma once

#include <vector>

#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// What a desktop is asked to become: its size and the screens that its window manager sees, at least one.
struct ScreenLayout {
  devices::Size desktop;
  std::vector<Box> screens;
  bool operator==(const ScreenLayout&) const = default;
};

}  // namespace pixelflex::viewer
