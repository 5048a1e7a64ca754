#include "viewer/panel/device_pane.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

constexpr std::array kJogSteps = {0.1, 0.5, 1.0, 5.0, 15.0};  // degrees

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string stepText(const char* axis, int steps, double degrees) {
  return fmt::format("{}{}={:g}", axis, steps < 0 ? "-" : "+", std::abs(steps) * degrees);
}

bool hasAny(const std::vector<const DeviceState*>& devices, const std::vector<std::string>& settings) {
  return std::ranges::any_of(devices, [&](const DeviceState* device) {
    return std::ranges::any_of(settings, [&](const std::string& name) { return device->find(name) != nullptr; });
  });
}

}  // namespace

void DevicePane::draw(PanelContext& panel, TestPictures& pictures) {
  const auto chosen = panel.chosen();
  if (chosen.empty()) {
    panelHeading("Settings");
    wrappedText(Colours::kDim,
                "Choose one or more projectors on the left or on the map. What is set here goes to all that are "
                "chosen, at once.");
    return;
  }
  ImGui::PushFont(panelFonts().title);
  const bool all = chosen.size() == panel.wall->wall->projectors.size() && chosen.size() > 1;
  shortText(Colours::kText, all ? fmt::format("All {} projectors", chosen.size()) : joined(chosen),
            ImGui::GetContentRegionAvail().x);
  ImGui::PopFont();
  drawTroubles(panel);
  drawTestPictures(panel, pictures);
  drawMirror(panel);
  drawSettings(panel, "Picture",
               {"power", "mute", "freeze", "input", "brightness", "contrast", "red", "green", "blue"});
  drawSettings(panel, "Lens", {"zoom", "focus", "shift_h", "shift_v", "lens_memory"});
  drawReadings(panel);
}

void DevicePane::drawTroubles(const PanelContext& panel) const {
  for (const bool mirrors : {false, true}) {
    for (const auto* device : panel.chosenDevices(mirrors)) {
      if (device->trouble.empty()) continue;
      const bool lost = device->contact == DeviceState::Contact::kLost;
      wrappedText(lost ? Colours::kBad : Colours::kWarn, device->trouble);
    }
  }
}

void DevicePane::drawMirror(PanelContext& panel) {
  const auto mirrors = panel.chosenDevices(true);
  if (mirrors.empty()) return;
  const auto moving = std::ranges::find_if(mirrors, [](const auto* mirror) { return !mirror->doing.empty(); });
  panelHeading(mirrors.size() == 1 ? "Mirror" : "Mirrors", moving == mirrors.end() ? "" : (*moving)->doing);
  drawJog(panel, panel.namesOf(mirrors));
  rows_.draw(panel, mirrors, "pan");
  rows_.draw(panel, mirrors, "tilt");
  ImGui::PushStyleColor(ImGuiCol_Header, 0);
  const bool open = ImGui::TreeNodeEx("Speed and limits", ImGuiTreeNodeFlags_SpanAvailWidth);
  ImGui::PopStyleColor();
  panel.map.add("mirror-more");
  if (!open) return;
  for (const auto* name : {"pan_speed", "tilt_speed", "pan_acceleration", "tilt_acceleration", "limits"}) {
    rows_.draw(panel, mirrors, name);
  }
  if (panelButton(panel, "reset", "Reset: find the ends of the axes", ButtonLook::kPlain, -1)) {
    panel.device(panel.namesOf(mirrors), {"reset"});
  }
  ImGui::TreePop();
}

void DevicePane::jog(const PanelContext& panel, int pan, int tilt) const {
  const auto mirrors = panel.chosenDevices(true);
  if (mirrors.empty()) return;
  std::vector<std::string> steps;
  if (pan != 0) steps.push_back(stepText("pan", pan, kJogSteps.at(jogStep_)));
  if (tilt != 0) steps.push_back(stepText("tilt", tilt, kJogSteps.at(jogStep_)));
  panel.device(panel.namesOf(mirrors), steps);
}

void DevicePane::drawJog(PanelContext& panel, const std::string& names) {
  const float side = 1.25F * ImGui::GetFrameHeight();
  const float gap = 0.5F * ImGui::GetStyle().ItemSpacing.x;
  const float left = ImGui::GetCursorPosX();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  ImGui::BeginGroup();
  ImGui::SetCursorPosX(left + side + gap);
  if (panelButton(panel, "jog-up", "↑", ButtonLook::kPlain, side, side)) jog(panel, 0, 1);
  if (panelButton(panel, "jog-left", "←", ButtonLook::kPlain, side, side)) jog(panel, -1, 0);
  ImGui::SameLine();
  if (panelButton(panel, "home", "⌂", ButtonLook::kPlain, side, side)) panel.device(names, {"home"});
  panelHint("Home: pan 0°, tilt 0°");
  ImGui::SameLine();
  if (panelButton(panel, "jog-right", "→", ButtonLook::kPlain, side, side)) jog(panel, 1, 0);
  ImGui::SetCursorPosX(left + side + gap);
  if (panelButton(panel, "jog-down", "↓", ButtonLook::kPlain, side, side)) jog(panel, 0, -1);
  ImGui::EndGroup();
  ImGui::SameLine(0, 3 * gap);
  ImGui::BeginGroup();
  ImGui::Dummy({0, side - ImGui::GetTextLineHeight() - gap - 2});
  dimText("Steps (also Alt+arrows)");
  const float width = std::floor((ImGui::GetContentRegionAvail().x - 4 * gap) / 5);
  for (std::size_t i = 0; i < kJogSteps.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    const ButtonLook look = i == jogStep_ ? ButtonLook::kChosen : ButtonLook::kPlain;
    if (panelButton(panel, "step-" + std::to_string(i), fmt::format("{:g}°", kJogSteps.at(i)), look, width)) {
      jogStep_ = i;
    }
  }
  if (panelButton(panel, "halt", "Halt", ButtonLook::kDanger, -1, side)) panel.device(names, {"halt"});
  panelHint("Stops these mirrors; F12 stops all of the wall");
  ImGui::EndGroup();
  ImGui::PopStyleVar();
}

void DevicePane::drawSettings(PanelContext& panel, const std::string& heading,
                              const std::vector<std::string>& settings) {
  const auto controls = panel.chosenDevices(false);
  if (!hasAny(controls, settings)) return;
  const auto busy = std::ranges::find_if(controls, [](const auto* control) { return !control->doing.empty(); });
  panelHeading(heading, busy == controls.end() ? "" : (*busy)->doing);
  for (const auto& setting : settings) rows_.draw(panel, controls, setting);
}

void DevicePane::drawReadings(const PanelContext& panel) const {
  panelHeading("Devices");
  for (const bool mirrors : {false, true}) {
    for (const auto* device : panel.chosenDevices(mirrors)) {
      ImGui::PushFont(panelFonts().small);
      const float width = ImGui::GetContentRegionAvail().x;
      const auto& line = device->device.line;
      shortText(Colours::kText, device->device.name + "  " + line.driver + "  " + line.at, width);
      if (!device->identity.empty()) shortText(Colours::kDim, device->identity, width);
      std::string readings;
      for (const auto& [info, value] : device->settings) {
        if (info.settable || value.empty()) continue;
        readings +=
            (readings.empty() ? "" : ", ") + info.name + " " + value + (info.unit.empty() ? "" : " " + info.unit);
      }
      if (!readings.empty()) wrappedText(Colours::kDim, readings);
      ImGui::PopFont();
    }
  }
  if (panel.chosenDevices(false).empty() && panel.chosenDevices(true).empty()) {
    wrappedText(Colours::kDim,
                "These projectors have no control and no mirror. Give them in wall.yaml, for example control: "
                "{driver: pjlink, at: \"tcp://10.0.0.5:4352\"}");
  }
}

void DevicePane::drawTestPictures(PanelContext& panel, TestPictures& pictures) {
  const auto chosen = panel.chosen();
  const bool several = chosen.size() > 1;
  panelHeading("Test picture", several ? "on each of them" : pictures.whereIs(panel, chosen.front()));
  const float gap = 0.5F * ImGui::GetStyle().ItemSpacing.x;
  constexpr std::size_t kInRow = 4;
  const float width = std::floor((ImGui::GetContentRegionAvail().x - (kInRow - 1) * gap) / kInRow);
  for (std::size_t i = 0; i < kTestPictures.size(); ++i) {
    const TestPicture& picture = kTestPictures.at(i);
    if (i % kInRow != 0) ImGui::SameLine(0, gap);
    const bool shown =
        std::ranges::all_of(chosen, [&](const auto& name) { return pictures.shownOn(name) == picture.name; });
    if (panelButton(panel, "picture-" + std::string(picture.name), std::string(picture.label),
                    shown ? ButtonLook::kChosen : ButtonLook::kPlain, width)) {
      pictures.show(panel, chosen, std::string(picture.name));
    }
  }
}

}  // namespace pixelflex::viewer
