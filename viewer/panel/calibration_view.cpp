#include "viewer/panel/calibration_view.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <ranges>
#include <utility>

#include "viewer/panel/open_file.h"
#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

struct Measurement {
  const char* name;
  const char* label;
  const char* what;
  std::vector<std::string> arguments;
};

const std::vector<Measurement>& measurements() {
  static const std::vector<Measurement> kAll = {
      {"geometry",
       "Geometry",
       "Where each projector's every pixel lands: after anything was moved.",
       {"camera", "surface", "projectors", "mesh"}},
      {"light", "Light", "Blend and brightness: after lamps, colours or the room have changed.", {"blend", "gamma"}},
      {"stale", "What is stale", "Only the steps whose photographs or settings have changed.", {}},
      {"all", "Everything anew", "Every step from the beginning.", {"--all"}},
      {"check",
       "Check drift",
       "One photograph a projector: says how far each has moved, changes nothing.",
       {"--check"}}};
  return kAll;
}

/// The last calibration, running or ended.
const ConsoleJob* lastCalibration(const WallSnapshot& wall) {
  const ConsoleJob* last = nullptr;
  for (const auto& job : wall.jobs) {
    if (job.kind == ConsoleJob::Kind::kCalibration) last = &job;
  }
  return last;
}

}  // namespace

void CalibrationView::begin(PanelContext& panel) {
  const auto arguments = *std::exchange(panel.choice.calibration, std::nullopt);
  panel.attempt([&] {
    const int job = panel.console.calibrate(arguments);
    const bool checks = std::ranges::find(arguments, "--check") != arguments.end();
    panel.choice.calibrationJob = checks ? 0 : job;
  });
}

void CalibrationView::update(PanelContext& panel) {
  const auto* job = panel.wall->find(panel.choice.calibrationJob);
  if (panel.choice.calibrationJob == 0 || (job != nullptr && job->running)) return;
  panel.choice.calibrationJob = 0;
  if (job != nullptr && job->error.empty() && panel.choice.opensReport) {
    openFile(panel.console, panel.console.folder() / "report.html");
  }
}

void CalibrationView::draw(PanelContext& panel) {
  drawState(panel);
  drawButtons(panel);
  drawLast(panel);
}

void CalibrationView::drawState(const PanelContext& panel) {
  const auto& calibration = panel.wall->calibration;
  if (!panel.wall->calibrationTrouble.empty()) return wrappedText(Colours::kBad, panel.wall->calibrationTrouble);
  if (!calibration) return wrappedText(Colours::kDim, "This wall has not been calibrated.");
  const auto lit =
      std::ranges::count_if(calibration->projectors, [](const auto& each) { return each.alpha.has_value(); });
  double worst = 0;
  for (const auto& projector : calibration->projectors) worst = std::max(worst, projector.quality.rms);
  dimText(fmt::format("{} of {} projectors calibrated, {} blended, residuals up to {:.3f} pixels",
                      calibration->projectors.size(), panel.wall->wall->projectors.size(), lit, worst));
}

void CalibrationView::drawButtons(PanelContext& panel) {
  const bool busy = panel.longJob() != nullptr || panel.choice.calibration;
  ImGui::BeginDisabled(busy);
  for (std::size_t i = 0; i < measurements().size(); ++i) {
    const auto& [name, label, what, arguments] = measurements()[i];
    const ButtonLook look = i < 2 ? ButtonLook::kStrong : ButtonLook::kPlain;
    if (panelButton(panel, std::string("calibrate-") + name, label, look, 150 * panelScale())) {
      panel.choice.calibration = arguments;
    }
    ImGui::SameLine();
    dimText(what);
  }
  ImGui::EndDisabled();
  ImGui::Spacing();
  if (panelButton(panel, "open-report", "Open the report", ButtonLook::kPlain, 150 * panelScale())) {
    openFile(panel.console, panel.console.folder() / "report.html");
  }
  ImGui::SameLine();
  ImGui::Checkbox("Open it when a calibration has ended", &panel.choice.opensReport);
  panel.map.add("opens-report");
}

void CalibrationView::drawLast(PanelContext& panel) {
  const auto* job = lastCalibration(*panel.wall);
  if (job == nullptr) return;
  panelHeading(job->running         ? "Calibrating"
               : job->error.empty() ? "Last calibration"
                                    : "Calibration failed",
               job->running ? job->state : "");
  if (job->running && job->part) {
    ImGui::ProgressBar(static_cast<float>(*job->part), {-1, 6 * panelScale()}, "");
  }
  ImGui::BeginChild("said", {0, 0}, false, ImGuiWindowFlags_HorizontalScrollbar);
  if (!job->error.empty()) wrappedText(Colours::kBad, job->error);
  ImGui::PushFont(panelFonts().fixed);
  for (const auto& line : job->said) ImGui::TextUnformatted(line.c_str());
  ImGui::PopFont();
  if (job->running) ImGui::SetScrollHereY(1);
  ImGui::EndChild();
}

void drawLongJob(PanelContext& panel, float width) {
  const auto* job = panel.longJob();
  if (job == nullptr) return;
  const float cancel = 70 * panelScale();
  const float bar = 110 * panelScale();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float left = ImGui::GetCursorPosX();
  const char* const what = job->kind == ConsoleJob::Kind::kPreset ? "Preset" : "Calibration";
  ImGui::AlignTextToFramePadding();
  shortText(Colours::kWarn, fmt::format("{}: {}", what, job->state.empty() ? "starting" : job->state),
            width - cancel - bar - 2 * gap);
  ImGui::SameLine(left + width - cancel - bar - gap);
  const std::string percent = job->part ? fmt::format("{:.0f} %", 100 * *job->part) : "";
  ImGui::ProgressBar(static_cast<float>(job->part.value_or(0)), {bar, 0}, percent.c_str());
  ImGui::SameLine(left + width - cancel);
  if (panelButton(panel, "cancel", "Cancel", ButtonLook::kPlain, cancel)) panel.console.cancel(job->number);
}

}  // namespace pixelflex::viewer
