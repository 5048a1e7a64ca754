#include "viewer/panel/preset_view.h"

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

constexpr const char* kAsk = "Delete this preset?";

const ConsoleJob* lastPresetJob(const WallSnapshot& wall) {
  const ConsoleJob* last = nullptr;
  for (const auto& job : wall.jobs) {
    if (job.kind == ConsoleJob::Kind::kPreset) last = &job;
  }
  return last;
}

/// "2026-11-23 02:47", UTC.
std::string timeOf(const PresetInfo& preset) {
  std::string text = preset.saved.substr(0, 16);
  if (text.size() > 10) text[10] = ' ';
  return text;
}

}  // namespace

void PresetView::draw(PanelContext& panel) {
  drawSave(panel);
  drawList(panel);
  drawLast(panel);
  drawDelete(panel);
}

void PresetView::drawSave(PanelContext& panel) {
  const bool busy = panel.longJob() != nullptr;
  ImGui::SetNextItemWidth(220 * panelScale());
  const bool entered = ImGui::InputTextWithHint("##name", "name of a new preset", name_.data(), name_.size(),
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  panel.map.add("preset-name");
  if (ImGui::IsItemActive()) panel.map.add("preset-name-active");
  ImGui::SameLine();
  ImGui::BeginDisabled(busy || name_[0] == '\0');
  const bool pressed = panelButton(panel, "preset-save", "Save what is now", ButtonLook::kStrong);
  ImGui::EndDisabled();
  if ((entered || pressed) && !busy && name_[0] != '\0') {
    panel.attempt([&] {
      (void)panel.console.savePreset(name_.data());
      name_ = {};
    });
  }
  ImGui::SameLine();
  ImGui::Checkbox("Verify with the camera after restoring", &verifies_);
  panel.map.add("preset-verify");
  ImGui::Spacing();
}

void PresetView::drawList(PanelContext& panel) {
  if (panel.wall->presets.empty()) {
    return wrappedText(Colours::kDim,
                       "There are no presets yet. One holds the settings of all devices and the calibration that "
                       "belongs to them, under a name.");
  }
  const float rows = static_cast<float>(std::min<std::size_t>(panel.wall->presets.size(), 6) + 1);
  const ImVec2 size = {0, rows * (ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().CellPadding.y + 1)};
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerH;
  if (!ImGui::BeginTable("presets", 5, kFlags, size)) return;
  const float scale = panelScale();
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("Preset");
  ImGui::TableSetupColumn("Saved (UTC)", ImGuiTableColumnFlags_WidthFixed, 118 * scale);
  ImGui::TableSetupColumn("Devices", ImGuiTableColumnFlags_WidthFixed, 54 * scale);
  ImGui::TableSetupColumn("Calibration", ImGuiTableColumnFlags_WidthFixed, 80 * scale);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 194 * scale);
  ImGui::TableHeadersRow();
  for (const auto& preset : panel.wall->presets) drawPreset(panel, preset);
  ImGui::EndTable();
}

void PresetView::drawPreset(PanelContext& panel, const PresetInfo& preset) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  shortText(preset.trouble.empty() ? Colours::kText : Colours::kBad, preset.name, ImGui::GetContentRegionAvail().x);
  if (!preset.trouble.empty()) panelHint(preset.trouble);
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  dimText(timeOf(preset));
  ImGui::TableNextColumn();
  dimText(std::to_string(preset.devices));
  ImGui::TableNextColumn();
  dimText(preset.calibrationInUse ? "in use" : preset.hasCalibration ? "its own" : "none");
  ImGui::TableNextColumn();
  ImGui::BeginDisabled(panel.longJob() != nullptr || !preset.trouble.empty());
  if (panelButton(panel, "preset-restore-" + preset.name, "Restore", ButtonLook::kStrong)) {
    panel.attempt([&] { (void)panel.console.restorePreset(preset.name, verifies_); });
  }
  ImGui::SameLine();
  if (panelButton(panel, "preset-plan-" + preset.name, "Plan")) {
    panel.attempt([&] { (void)panel.console.planPreset(preset.name); });
  }
  panelHint("Says what restoring would do, and changes nothing");
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (panelButton(panel, "preset-delete-" + preset.name, "Delete")) deleting_ = preset.name;
}

void PresetView::drawDelete(PanelContext& panel) {
  if (!deleting_.empty() && !ImGui::IsPopupOpen(kAsk)) ImGui::OpenPopup(kAsk);
  if (!ImGui::BeginPopupModal(kAsk, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ImGui::TextUnformatted(deleting_.c_str());
  dimText("Its device settings and, if no other preset has it, its calibration go.");
  ImGui::Spacing();
  if (panelButton(panel, "delete-yes", "Delete", ButtonLook::kDanger, 110 * panelScale())) {
    panel.attempt([&] { (void)panel.console.deletePreset(deleting_); });
    deleting_.clear();
    ImGui::CloseCurrentPopup();
  }
  ImGui::SameLine();
  if (panelButton(panel, "delete-no", "Keep", ButtonLook::kPlain, 110 * panelScale())) {
    deleting_.clear();
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

/// What the last command about presets is doing or said.
void PresetView::drawLast(const PanelContext& panel) {
  const auto* job = lastPresetJob(*panel.wall);
  if (job == nullptr) return;
  panelHeading(job->running ? "Under way" : job->error.empty() ? "Done" : "Failed", job->command);
  if (job->running) {
    ImGui::ProgressBar(static_cast<float>(job->part.value_or(0)), {-1, 6 * panelScale()}, "");
    dimText(job->state);
  }
  ImGui::BeginChild("said");
  if (!job->error.empty()) wrappedText(Colours::kBad, job->error);
  ImGui::PushFont(panelFonts().fixed);
  for (const auto& line : job->said) ImGui::TextUnformatted(line.c_str());
  ImGui::PopFont();
  ImGui::EndChild();
}

}  // namespace pixelflex::viewer
