#include "viewer/panel/panel.h"

#include <X11/keysym.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

// At a scale of 1.
constexpr float kListWidth = 248;
constexpr float kPaneWidth = 356;
constexpr float kTopHeight = 48;
constexpr float kLogHeight = 118;

struct Health {
  std::string text;
  std::uint32_t colour;
};

Health healthOf(const WallSnapshot& wall) {
  const auto in = [&](DeviceState::Contact contact) {
    return std::ranges::count_if(wall.devices, [&](const auto& state) { return state->contact == contact; });
  };
  const auto lost = in(DeviceState::Contact::kLost);
  const auto waiting = in(DeviceState::Contact::kNotYet);
  if (wall.devices.empty()) return {"no devices in wall.yaml", Colours::kDim};
  if (lost > 0) return {fmt::format("{} of {} devices do not answer", lost, wall.devices.size()), Colours::kBad};
  if (waiting > 0) return {fmt::format("connecting to {} devices", waiting), Colours::kDim};
  return {fmt::format("all {} devices answer", wall.devices.size()), Colours::kGood};
}

bool beginPane(const char* name, float width, float height) {
  const bool visible = ImGui::BeginChild(name, {width, height}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
  return visible;
}

}  // namespace

Panel::Panel(WallConsole& console, const PanelOptions& options)
    : console_(console),
      choice_(options.choice),
      controls_(options.controls),
      feed_(console.folder(), console.snapshot()->wall),
      pictures_([this](const std::string& projector,
                       devices::Image8 frame) { feed_.showInRoom(projector, std::move(frame)); },
                options.programs),
      map_(console.folder()),
      camera_(feed_) {}

PanelContext Panel::context() {
  return {console_, console_.snapshot(), choice_, controls_};
}

std::uint64_t Panel::revision() const {
  return console_.snapshot()->revision + (feed_.latest()->number << 32U);
}

bool Panel::shortcut(const devices::KeyStroke& stroke) {
  if (stroke.keysym == XK_Alt_L || stroke.keysym == XK_Alt_R) alt_ = stroke.pressed;
  if (stroke.keysym == XK_F12) {
    if (stroke.pressed) (void)console_.stopAll();
    return true;
  }
  const bool arrow = stroke.keysym >= XK_Left && stroke.keysym <= XK_Down;
  if (!alt_ || !arrow) return false;
  const int pan = stroke.keysym == XK_Left ? -1 : stroke.keysym == XK_Right ? 1 : 0;
  const int tilt = stroke.keysym == XK_Down ? -1 : stroke.keysym == XK_Up ? 1 : 0;
  if (stroke.pressed) pane_.jog(context(), pan, tilt);
  return true;
}

void Panel::draw() {
  PanelContext panel = context();
  map_.update(*panel.wall);
  updateCamera(panel);
  CalibrationView::update(panel);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(size);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
  ImGui::Begin("panel", nullptr, kFlags);
  drawTop(panel);
  drawMiddle(panel);
  if (beginPane("log", 0, 0)) log_.draw(panel);
  ImGui::EndChild();
  ImGui::End();
  controls_.finish();
}

/// A calibration needs the camera for itself.
void Panel::updateCamera(PanelContext& panel) {
  feed_.want(cameraOpen_ && !panel.longJob() && !panel.choice.calibration);
  if (panel.choice.calibration && feed_.isClosed()) CalibrationView::begin(panel);
}

void Panel::drawTop(PanelContext& panel) {
  const float scale = panelScale();
  const float stop = 190 * scale;
  const float height = (kTopHeight - 10) * scale;
  const float top = ImGui::GetCursorPosY();
  const float textTop = top + 0.5F * (height - ImGui::GetFrameHeight());
  const float right = ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x;
  ImGui::SetCursorPosY(textTop);
  ImGui::PushFont(panelFonts().title);
  ImGui::AlignTextToFramePadding();
  shortText(Colours::kText, std::filesystem::absolute(console_.folder()).lexically_normal().filename().string(),
            200 * scale);
  ImGui::PopFont();
  ImGui::SameLine(0, 18 * scale);
  const Health health = healthOf(*panel.wall);
  ImGui::SetCursorPosY(textTop);
  ImGui::AlignTextToFramePadding();
  statusDot(health.colour);
  colouredText(health.colour, health.text);
  const float left = ImGui::GetItemRectMax().x + 30 * scale;
  ImGui::SetCursorPos({left, textTop});
  drawLongJob(panel, right - stop - 16 * scale - left);
  ImGui::SetCursorPos({right - stop, top});
  ImGui::PushFont(panelFonts().strong);
  if (panelButton(panel, "stop-all", "STOP ALL  (F12)", ButtonLook::kDanger, stop, height)) (void)console_.stopAll();
  ImGui::PopFont();
}

void Panel::drawMiddle(PanelContext& panel) {
  const float scale = panelScale();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float height = ImGui::GetContentRegionAvail().y - kLogHeight * scale;
  if (beginPane("list", kListWidth * scale, height)) list_.draw(panel);
  ImGui::EndChild();
  ImGui::SameLine();
  const float width = ImGui::GetContentRegionAvail().x - kPaneWidth * scale - gap;
  beginPane("tabs", width, height);
  if (ImGui::BeginTabBar("tabs")) {
    drawTab(panel, "map", "Wall");
    drawTab(panel, "camera", "Camera");
    drawTab(panel, "calibration", "Calibration");
    drawTab(panel, "presets", "Presets");
    ImGui::EndTabBar();
  }
  panel.choice.tab.clear();
  ImGui::EndChild();
  ImGui::SameLine();
  if (beginPane("pane", kPaneWidth * scale, height)) pane_.draw(panel, pictures_);
  ImGui::EndChild();
}

void Panel::drawTab(PanelContext& panel, const char* name, const char* label) {
  const std::string tab = name;
  const ImGuiTabItemFlags flags = panel.choice.tab == tab ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
  const bool open = ImGui::BeginTabItem(label, nullptr, flags);
  panel.map.add("tab-" + tab);
  if (tab == "camera") cameraOpen_ = open;
  if (!open) return;
  if (tab == "map") map_.draw(panel);
  if (tab == "camera") camera_.draw(panel);
  if (tab == "calibration") calibration_.draw(panel);
  if (tab == "presets") presets_.draw(panel);
  ImGui::EndTabItem();
}

}  // namespace pixelflex::viewer
