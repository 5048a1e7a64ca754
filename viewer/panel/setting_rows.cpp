#include "viewer/panel/setting_rows.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

constexpr float kLabelWidth = 96;
constexpr std::size_t kMostButtons = 3;

double numberOf(const std::string& text) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::string labelOf(const std::string& setting) {
  std::string text = setting;
  std::ranges::replace(text, '_', ' ');
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// As many digits as the setting's steps have.
int digitsOf(const devices::SettingInfo& info) {
  return info.step >= 1 ? 0 : info.step >= 0.1 ? 1 : 2;
}

/// Behind a slider: filled up to its value, so that the number stays readable.
void drawBar(const devices::SettingInfo& info, double value, bool known, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight();
  const float rounding = ImGui::GetStyle().FrameRounding;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, Colours::kRaised, rounding);
  if (!known || info.maximum <= info.minimum) return;
  const double part = std::clamp((value - info.minimum) / (info.maximum - info.minimum), 0.0, 1.0);
  list.AddRectFilled(at, {at.x + width * static_cast<float>(part), at.y + height}, Colours::kAccentDeep, rounding);
}

}  // namespace

struct SettingRows::Shared {
  std::vector<const DeviceState*> devices;
  const devices::SettingInfo* info = nullptr;  // of the first
  std::string names;
  std::string id;
  std::string value;  // of the first, or what was wished
  bool differs = false;
  bool known = true;
};

void SettingRows::draw(PanelContext& panel, const std::vector<const DeviceState*>& devices,
                       const std::string& setting) {
  Shared shared;
  for (const auto* device : devices) {
    const auto* state = device->find(setting);
    if (state == nullptr) continue;
    if (shared.info == nullptr) {
      shared.info = &state->info;
      shared.value = state->value;
    }
    shared.differs = shared.differs || state->value != shared.value;
    shared.devices.push_back(device);
  }
  if (shared.info == nullptr || !shared.info->settable) return;
  shared.names = panel.namesOf(shared.devices);
  shared.id = shared.names + " " + setting;
  if (const auto wish = wishes_.find(shared.id); wish != wishes_.end()) {
    const auto* job = panel.wall->find(wish->second.job);
    if (job != nullptr && job->running) {
      shared.value = wish->second.value;
      shared.differs = false;
    }
  }
  shared.known = !shared.value.empty();
  ImGui::AlignTextToFramePadding();
  colouredText(Colours::kText, labelOf(setting));
  ImGui::SameLine(kLabelWidth * panelScale());
  ImGui::PushID(setting.c_str());
  if (shared.info->words) {
    drawWords(panel, shared);
  } else if (!shared.info->readable && shared.info->nudgeable) {
    drawSteps(panel, shared);
  } else {
    drawNumber(panel, shared);
  }
  ImGui::PopID();
}

void SettingRows::set(PanelContext& panel, const Shared& shared, const std::string& value) {
  const int job = panel.device(shared.names, {shared.info->name + "=" + value});
  wishes_[shared.id] = {job, value};
}

void SettingRows::drawNumber(PanelContext& panel, const Shared& shared) {
  const devices::SettingInfo& info = *shared.info;
  const float step = ImGui::GetFrameHeight();
  const float gap = 0.5F * ImGui::GetStyle().ItemSpacing.x;
  const float buttons = info.nudgeable ? 2 * (step + gap) : 0;
  double value = edited_ == shared.id ? editedValue_ : numberOf(shared.value);
  std::string format = fmt::format("%.{}f {}", digitsOf(info), info.unit == "deg" ? "°" : info.unit);
  if (shared.differs) format = "not all alike";
  if (!shared.known) format = "not known";
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - buttons);
  drawBar(info, value, shared.known && !shared.differs, ImGui::CalcItemWidth());
  ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
  if (ImGui::SliderScalar("##number", ImGuiDataType_Double, &value, &info.minimum, &info.maximum,
                          edited_ == shared.id ? fmt::format("%.{}f", digitsOf(info)).c_str() : format.c_str(),
                          ImGuiSliderFlags_AlwaysClamp)) {
    edited_ = shared.id;
    editedValue_ = value;
  }
  ImGui::PopStyleColor();
  panel.map.add("set-" + info.name);
  panelHint(rangeText(info) + (info.approximate ? ", by counting steps" : "") + "; Ctrl+click to type it");
  if (ImGui::IsItemDeactivatedAfterEdit()) {
    set(panel, shared, fmt::format("{:.{}f}", editedValue_, digitsOf(info)));
  }
  if (!ImGui::IsItemActive() && edited_ == shared.id) edited_.clear();
  if (!info.nudgeable) return;
  const std::string by = info.step >= 1 ? "1" : "0.5";
  ImGui::SameLine(0, gap);
  if (panelButton(panel, "less-" + info.name, "−", ButtonLook::kPlain, step)) {
    panel.device(shared.names, {info.name + "-=" + by});
  }
  ImGui::SameLine(0, gap);
  if (panelButton(panel, "more-" + info.name, "+", ButtonLook::kPlain, step)) {
    panel.device(shared.names, {info.name + "+=" + by});
  }
}

void SettingRows::drawWords(PanelContext& panel, const Shared& shared) {
  const devices::SettingInfo& info = *shared.info;
  const float gap = 0.5F * ImGui::GetStyle().ItemSpacing.x;
  if (info.choices.size() > kMostButtons) {
    ImGui::SetNextItemWidth(-1);
    const std::string shown = shared.differs ? "not all alike" : shared.known ? shared.value : "not known";
    if (ImGui::BeginCombo("##words", shown.c_str())) {
      for (const auto& choice : info.choices) {
        if (ImGui::Selectable(choice.c_str(), choice == shared.value)) set(panel, shared, choice);
      }
      ImGui::EndCombo();
    } else {
      panel.map.add("set-" + info.name);
    }
    return;
  }
  const auto count = static_cast<float>(std::max<std::size_t>(info.choices.size(), 1));
  const float width = std::floor((ImGui::GetContentRegionAvail().x - (count - 1) * gap) / count);
  for (std::size_t i = 0; i < info.choices.size(); ++i) {
    const std::string& choice = info.choices[i];
    if (i > 0) ImGui::SameLine(0, gap);
    const bool now = choice == shared.value && !shared.differs;
    const std::string name = "set-" + info.name + "-" + choice;
    if (panelButton(panel, name, choice, now ? ButtonLook::kChosen : ButtonLook::kPlain, width)) {
      set(panel, shared, choice);
    }
  }
}

/// What can only be turned: by one step, or by ten.
void SettingRows::drawSteps(PanelContext& panel, const Shared& shared) {
  const devices::SettingInfo& info = *shared.info;
  const float gap = 0.5F * ImGui::GetStyle().ItemSpacing.x;
  const float width = std::floor((ImGui::GetContentRegionAvail().x - 3 * gap) / 4);
  constexpr std::array<std::pair<const char*, const char*>, 4> kSteps = {
      {{"−10", "-=10"}, {"−1", "-=1"}, {"+1", "+=1"}, {"+10", "+=10"}}};
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    const auto& [text, step] = kSteps.at(i);
    if (i > 0) ImGui::SameLine(0, gap);
    if (panelButton(panel, "turn-" + info.name + "-" + std::to_string(i), text, ButtonLook::kPlain, width)) {
      panel.device(shared.names, {info.name + step});
    }
  }
}

}  // namespace pixelflex::viewer
