#include "viewer/panel/log_view.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <string>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

std::string clockText(std::chrono::system_clock::time_point at) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(at);
  std::tm parts{};
  ::localtime_r(&seconds, &parts);
  std::array<char, 16> text{};
  (void)std::strftime(text.data(), text.size(), "%H:%M:%S", &parts);
  return text.data();
}

std::uint32_t colourOf(LogLine::Kind kind) {
  if (kind == LogLine::Kind::kError) return Colours::kBad;
  return kind == LogLine::Kind::kCommand ? Colours::kText : Colours::kDim;
}

void drawLine(const LogLine& line) {
  dimText(clockText(line.at));
  ImGui::SameLine();
  const bool command = line.kind == LogLine::Kind::kCommand;
  shortText(colourOf(line.kind), (command ? "$ " : "") + line.text, ImGui::GetContentRegionAvail().x);
}

}  // namespace

void LogView::draw(const PanelContext& panel) {
  const auto& log = panel.wall->log;
  ImGui::PushFont(panelFonts().fixed);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * panelScale(), 2 * panelScale()});
  const bool atEnd = ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(log.size()));
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) drawLine(*log[static_cast<std::size_t>(i)]);
  }
  const std::uint64_t last = log.empty() ? 0 : log.back()->number;
  if (last != last_ && (atEnd || last_ == 0)) ImGui::SetScrollHereY(1);
  last_ = last;
  ImGui::PopStyleVar();
  ImGui::PopFont();
}

}  // namespace pixelflex::viewer
