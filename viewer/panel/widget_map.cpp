#include "viewer/panel/widget_map.h"

#include <fmt/format.h>
#include <imgui.h>

#include "devices/image/atomic_file.h"

namespace pixelflex::viewer {

void WidgetMap::add(const std::string& name) {
  if (file_.empty() || !ImGui::IsItemVisible()) return;
  const ImVec2 topLeft = ImGui::GetItemRectMin();
  const ImVec2 bottomRight = ImGui::GetItemRectMax();
  add(name, topLeft.x, topLeft.y, bottomRight.x, bottomRight.y);
}

void WidgetMap::add(const std::string& name, float left, float top, float right, float bottom) {
  if (file_.empty()) return;
  lines_ += fmt::format("{} {:.0f} {:.0f} {:.0f} {:.0f}\n", name, left, top, right - left, bottom - top);
}

void WidgetMap::finish() {
  if (!file_.empty() && lines_ != written_) {
    devices::writeFileAtomically(file_, lines_);
    written_ = lines_;
  }
  lines_.clear();
}

}  // namespace pixelflex::viewer
