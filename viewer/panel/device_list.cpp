#include "viewer/panel/device_list.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <charconv>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

constexpr float kNameWidth = 64;

std::string valueOf(const DeviceState& state, const std::string& setting) {
  const auto* found = state.find(setting);
  return found == nullptr ? "" : found->value;
}

/// "12.5", not "12.4997".
std::string degrees(const std::string& text) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return fmt::format("{:.1f}°", number + 0.0);
}

/// What matters most about a device in few words.
std::string summaryOf(const DeviceState& state) {
  if (state.device.isMirror) {
    const std::string pan = valueOf(state, "pan");
    const std::string tilt = valueOf(state, "tilt");
    return pan.empty() ? "" : "pan " + degrees(pan) + "  tilt " + degrees(tilt);
  }
  std::string text = valueOf(state, "power");
  if (valueOf(state, "mute") == "on") text += ", muted";
  if (const auto input = valueOf(state, "input"); !input.empty()) text += ", " + input;
  return text;
}

void drawDevice(const DeviceState* state, const char* what) {
  if (state == nullptr) {
    statusDot(Colours::kLine);
    dimText(std::string("no ") + what);
    return;
  }
  const DeviceWords words = wordsOf(*state);
  statusDot(words.colour);
  const float width = ImGui::GetContentRegionAvail().x - 4 * panelScale();
  if (words.text.empty()) {
    shortText(Colours::kDim, summaryOf(*state), width);
  } else {
    shortText(words.colour, words.text, width);
  }
}

}  // namespace

void DeviceList::draw(PanelContext& panel) {
  const auto& projectors = panel.wall->wall->projectors;
  panelHeading("Projectors",
               std::to_string(panel.choice.projectors.size()) + " of " + std::to_string(projectors.size()) + " chosen");
  const float half = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (panelButton(panel, "choose-all", "Choose all", ButtonLook::kPlain, half)) {
    for (const auto& projector : projectors) panel.choice.projectors.insert(projector.name);
  }
  ImGui::SameLine();
  if (panelButton(panel, "choose-none", "Choose none", ButtonLook::kPlain, half)) panel.choice.projectors.clear();
  ImGui::BeginChild("rows");
  for (std::size_t i = 0; i < projectors.size(); ++i) drawRow(panel, i);
  ImGui::EndChild();
}

void DeviceList::drawRow(PanelContext& panel, std::size_t index) {
  const std::string& name = panel.wall->wall->projectors[index].name;
  const float scale = panelScale();
  const float line = ImGui::GetTextLineHeight() + 3 * scale;
  const float height = 2 * line + 6 * scale;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 local = ImGui::GetCursorPos();
  ImGui::PushID(static_cast<int>(index));
  if (ImGui::Selectable("##row", panel.choice.projectors.contains(name), 0, {0, height})) choose(panel, index);
  panel.map.add("projector-" + name);
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + 4 * scale, at.y + height}, colourOfProjector(index), 2 * scale);
  ImGui::SetCursorPos({local.x + 12 * scale, local.y + 3 * scale});
  ImGui::PushFont(panelFonts().strong);
  shortText(Colours::kText, name, (kNameWidth - 16) * scale);
  ImGui::PopFont();
  ImGui::SetCursorPos({local.x + kNameWidth * scale, local.y + 3 * scale});
  drawDevice(panel.wall->find(name + ".control"), "control");
  ImGui::SetCursorPos({local.x + kNameWidth * scale, local.y + 3 * scale + line});
  drawDevice(panel.wall->find(name + ".mirror"), "mirror");
  ImGui::SetCursorPos({local.x, local.y + height + 3 * scale});
  ImGui::PopID();
}

void DeviceList::choose(PanelContext& panel, std::size_t index) {
  const auto& projectors = panel.wall->wall->projectors;
  const std::string& name = projectors[index].name;
  auto& chosen = panel.choice.projectors;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyShift) {
    for (std::size_t i = std::min(last_, index); i <= std::max(last_, index); ++i) chosen.insert(projectors[i].name);
    return;
  }
  last_ = index;
  if (!io.KeyCtrl) {
    chosen = {name};
  } else if (chosen.erase(name) == 0) {
    chosen.insert(name);
  }
}

}  // namespace pixelflex::viewer
