#pragma once

#include <cstdint>

#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// The console's log; stays at its end unless somebody has scrolled up. Main thread.
class LogView {
 public:
  void draw(const PanelContext& panel);

 private:
  std::uint64_t last_ = 0;
};

}  // namespace pixelflex::viewer
