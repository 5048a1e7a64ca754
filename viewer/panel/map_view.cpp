#include "viewer/panel/map_view.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/geometry/footprint.h"
#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

ImVec2 vec(glm::vec2 point) {
  return {point.x, point.y};
}

bool contains(const std::vector<glm::dvec2>& outline, glm::dvec2 point) {
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::dvec2 a = outline[i];
    const glm::dvec2 b = outline[j];
    if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
      inside = !inside;
    }
  }
  return inside;
}

void centredText(ImDrawList& list, glm::vec2 at, std::uint32_t colour, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddText({std::round(at.x - size.x / 2), std::round(at.y - size.y / 2)}, colour, text.c_str());
}

std::string stepOf(const char* setting, double counts) {
  return fmt::format("{}{}={:.0f}", setting, counts < 0 ? "-" : "+", std::abs(counts));
}

}  // namespace

void MapView::measure(const WallSnapshot& wall) {
  if (measured_ == wall.calibration) return;
  measured_ = wall.calibration;
  footprints_.clear();
  aimed_.clear();
  drag_.reset();
  if (!measured_) return;
  const auto& display = measured_->display;
  topLeft_ = display ? glm::dvec2(display->left, display->top) : glm::dvec2(1e30);
  bottomRight_ = display ? glm::dvec2(display->right, display->bottom) : glm::dvec2(-1e30);
  for (std::size_t i = 0; i < wall.wall->projectors.size(); ++i) {
    const auto* projector = measured_->find(wall.wall->projectors[i].name);
    if (projector == nullptr) continue;
    try {
      const calib::ProjectorMapping mapping(*projector);
      footprints_.push_back({projector->name, i, calib::footprint(mapping), centreInWall(*projector)});
    } catch (const std::exception&) {
      continue;  // a frame that misses the wall has no footprint
    }
    for (const auto& point : footprints_.back().outline) {
      topLeft_ = glm::min(topLeft_, point);
      bottomRight_ = glm::max(bottomRight_, point);
    }
  }
}

MapView::View MapView::viewIn(glm::dvec2 topLeft, glm::dvec2 size) const {
  const glm::dvec2 extent = bottomRight_ - topLeft_;
  const glm::dvec2 fit = size / extent;
  constexpr double kMargin = 0.94;
  const double scale = kMargin * std::min(fit.x, fit.y);
  return {topLeft_ + 0.5 * extent, topLeft + 0.5 * size, scale};
}

const MapView::Footprint* MapView::footprintAt(glm::dvec2 pointInWall) const {
  const Footprint* best = nullptr;
  for (const auto& footprint : footprints_) {
    if (!contains(footprint.outline, pointInWall)) continue;
    if (best == nullptr || glm::distance(footprint.centre, pointInWall) < glm::distance(best->centre, pointInWall)) {
      best = &footprint;
    }
  }
  return best;
}

void MapView::draw(PanelContext& panel) {
  measure(*panel.wall);
  if (footprints_.empty()) {
    wrappedText(panel.wall->calibrationTrouble.empty() ? Colours::kDim : Colours::kBad,
                panel.wall->calibrationTrouble.empty()
                    ? "This wall has not been calibrated: the map shows where each projector's light falls once it has "
                      "been. The Calibration tab does it."
                    : panel.wall->calibrationTrouble);
    return;
  }
  drawRemarks(panel);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size = ImGui::GetContentRegionAvail();
  if (size.x < 20 || size.y < 20) return;
  ImGui::InvisibleButton("map", size);
  panel.map.add("map");
  const View view = viewIn({at.x, at.y}, {size.x, size.y});
  takePointer(panel, view);
  drawWall(panel, view);
  for (const auto& footprint : footprints_) drawFootprint(panel, view, footprint);
}

void MapView::drawRemarks(const PanelContext& panel) const {
  if (!drag_) {
    return dimText(aimed_.empty() ? "Drag a footprint to aim its mirror; click to choose a projector."
                                  : "Dashed: aimed since the last calibration. Calibrate to see where it is exactly.");
  }
  const auto aim = book_.aimOf(*panel.wall, drag_->projector);
  if (!aim) return colouredText(Colours::kWarn, drag_->projector + " has no mirror whose position is known.");
  const auto* mirror = panel.wall->find(drag_->projector + ".mirror");
  const glm::dvec2 counts = aim->countsFor(drag_->by);
  const glm::dvec2 degrees = counts * glm::dvec2(mirror->find("pan")->info.step, mirror->find("tilt")->info.step);
  const char* const source = aim->measured == 2   ? "by measured moves"
                             : aim->measured == 1 ? "one direction measured, the other by the mirror's geometry"
                                                  : "by the mirror's geometry";
  colouredText(Colours::kText,
               fmt::format("{}: pan {:+.2f}°, tilt {:+.2f}°  ({})", drag_->projector, degrees.x, degrees.y, source));
}

void MapView::takePointer(PanelContext& panel, const View& view) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::dvec2 pointer = {io.MousePos.x, io.MousePos.y};
  const glm::dvec2 pointInWall = view.wallAt + (pointer - view.windowAt) / view.scale;
  if (ImGui::IsItemActivated()) {
    const Footprint* hit = footprintAt(pointInWall);
    if (!io.KeyCtrl) panel.choice.projectors.clear();
    if (hit != nullptr) panel.choice.projectors.insert(hit->projector);
    if (hit != nullptr) drag_ = Drag{hit->projector, pointer, {0, 0}};
  }
  if (!drag_) return;
  // A hand that only clicks trembles.
  constexpr double kTremble = 4;
  const glm::dvec2 moved = pointer - drag_->from;
  drag_->by = glm::length(moved) < kTremble * panelScale() ? glm::dvec2(0, 0) : moved / view.scale;
  if (!ImGui::IsItemDeactivated()) return;
  const Drag drag = *drag_;
  drag_.reset();
  if (glm::length(drag.by) > 0) aim(panel, drag);
}

void MapView::aim(PanelContext& panel, const Drag& drag) {
  const auto aim = book_.aimOf(*panel.wall, drag.projector);
  if (!aim) return;
  const glm::dvec2 counts = aim->countsFor(drag.by);
  std::vector<std::string> steps;
  if (counts.x != 0) steps.push_back(stepOf("pan_counts", counts.x));
  if (counts.y != 0) steps.push_back(stepOf("tilt_counts", counts.y));
  if (steps.empty()) return;
  if (panel.device(drag.projector + ".mirror", steps) != 0) aimed_[drag.projector] += aim->wallFromCounts * counts;
}

void MapView::drawWall(const PanelContext& panel, const View& view) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto& display = panel.wall->calibration->display;
  if (!display) return;
  const ImVec2 topLeft = vec(view({display->left, display->top}));
  const ImVec2 bottomRight = vec(view({display->right, display->bottom}));
  list.AddRectFilled(topLeft, bottomRight, panelColour(0xFFFFFF, 10));
  list.AddRect(topLeft, bottomRight, Colours::kDim, 0, 0, 1.5F * panelScale());
  const std::string text = fmt::format("{} × {}", display->resolution.width, display->resolution.height);
  ImGui::PushFont(panelFonts().small);
  list.AddText({topLeft.x + 6 * panelScale(), topLeft.y + 4 * panelScale()}, Colours::kDim, text.c_str());
  ImGui::PopFont();
}

void MapView::drawFootprint(PanelContext& panel, const View& view, const Footprint& footprint) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool chosen = panel.choice.projectors.contains(footprint.projector);
  std::vector<ImVec2> points;
  for (const auto& point : footprint.outline) points.push_back(vec(view(point)));
  const int count = static_cast<int>(points.size());
  list.AddConvexPolyFilled(points.data(), count, colourOfProjector(footprint.index, chosen ? 80 : 34));
  list.AddPolyline(points.data(), count, colourOfProjector(footprint.index), ImDrawFlags_Closed,
                   (chosen ? 2.5F : 1.2F) * panelScale());
  glm::dvec2 moved{0, 0};
  if (const auto aimed = aimed_.find(footprint.projector); aimed != aimed_.end()) moved = aimed->second;
  if (drag_ && drag_->projector == footprint.projector) moved += drag_->by;
  const glm::vec2 shift(view.scale * moved);
  for (std::size_t i = 0; moved != glm::dvec2(0, 0) && i + 2 < points.size(); i += 4) {
    list.AddLine({points[i].x + shift.x, points[i].y + shift.y}, {points[i + 2].x + shift.x, points[i + 2].y + shift.y},
                 Colours::kText, 1.5F * panelScale());
  }
  const glm::vec2 centre = view(footprint.centre + moved);
  ImGui::PushFont(chosen ? panelFonts().title : panelFonts().strong);
  centredText(list, centre, Colours::kText, footprint.projector);
  ImGui::PopFont();
  panel.map.add("footprint-" + footprint.projector, centre.x - 2, centre.y - 2, centre.x + 2, centre.y + 2);
}

}  // namespace pixelflex::viewer
