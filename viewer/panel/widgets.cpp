#include "viewer/panel/widgets.h"

#include <imgui.h>
#include <imgui_internal.h>

#include "viewer/panel/panel_style.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

struct ButtonColours {
  std::uint32_t usual, hovered, active;
};

ButtonColours coloursOf(ButtonLook look) {
  if (look == ButtonLook::kChosen) return {Colours::kAccentDeep, Colours::kAccent, Colours::kAccent};
  if (look == ButtonLook::kStrong) return {Colours::kAccent, panelColour(0x5A9DFF), Colours::kAccentDeep};
  if (look == ButtonLook::kDanger) return {Colours::kStop, Colours::kStopHover, panelColour(0x8E1820)};
  return {Colours::kRaised, Colours::kHover, Colours::kAccentDeep};
}

/// A row of a list names the device already.
std::string withoutAddress(const DeviceState& state, const std::string& trouble) {
  const std::string line = trouble.substr(0, trouble.find('\n'));
  const auto colon = line.find(": ");
  return line.starts_with(state.device.name) && colon != std::string::npos ? line.substr(colon + 2) : line;
}

}  // namespace

bool panelButton(PanelContext& panel, const std::string& name, const std::string& text, ButtonLook look, float width,
                 float height) {
  const ButtonColours colours = coloursOf(look);
  ImGui::PushStyleColor(ImGuiCol_Button, colours.usual);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colours.hovered);
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, colours.active);
  const bool pressed = ImGui::Button((text + "##" + name).c_str(), {width, height});
  ImGui::PopStyleColor(3);
  panel.map.add(name);
  return pressed;
}

void panelHint(const std::string& text) {
  constexpr float kRest = 0.5F;  // seconds
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const bool isControl = context.HoveredId != 0;
  if (!isControl || context.HoveredIdTimer >= kRest) ImGui::SetTooltip("%s", text.c_str());
}

void dimText(const std::string& text) {
  colouredText(Colours::kDim, text);
}

void colouredText(std::uint32_t colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void wrappedText(std::uint32_t colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void panelHeading(const std::string& text, const std::string& remark) {
  ImGui::Dummy({0, 2 * panelScale()});
  ImGui::PushFont(panelFonts().strong);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
  if (!remark.empty()) {
    ImGui::SameLine();
    shortText(Colours::kDim, remark, ImGui::GetContentRegionAvail().x);
  }
  ImGui::Separator();
}

void statusDot(std::uint32_t colour) {
  const float height = ImGui::GetTextLineHeight();
  const float radius = 0.29F * height;
  const ImVec2 before = ImGui::GetCursorScreenPos();
  ImGui::Dummy({2 * radius + 2, height});
  ImGui::SameLine();
  // Where the text will be: it may stand lower for the sake of a button in its line.
  const float top = before.y + ImGui::GetCurrentWindow()->DC.CurrLineTextBaseOffset;
  ImGui::GetWindowDrawList()->AddCircleFilled({before.x + radius + 1, top + 0.55F * height}, radius, colour);
}

void shortText(std::uint32_t colour, const std::string& text, float width) {
  const std::string line = text.substr(0, text.find('\n'));
  if (line.size() == text.size() && ImGui::CalcTextSize(line.c_str()).x <= width) return colouredText(colour, line);
  std::string shown = line;
  while (shown.size() > 1 && ImGui::CalcTextSize((shown + "…").c_str()).x > width) {
    shown.pop_back();
    // Not in the middle of a letter.
    while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0xC0U) == 0x80U) shown.pop_back();
  }
  colouredText(colour, shown + "…");
  panelHint(text);
}

DeviceWords wordsOf(const DeviceState& state) {
  if (!state.doing.empty()) return {state.doing, Colours::kWarn};
  if (state.contact == DeviceState::Contact::kLost) return {withoutAddress(state, state.trouble), Colours::kBad};
  if (!state.trouble.empty()) return {withoutAddress(state, state.trouble), Colours::kWarn};
  const bool silent = state.contact == DeviceState::Contact::kNotYet && state.settings.empty();
  if (silent) return {"connecting", Colours::kDim};
  return {"", Colours::kGood};
}

}  // namespace pixelflex::viewer
