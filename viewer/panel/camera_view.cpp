#include "viewer/panel/camera_view.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <set>

#include "viewer/panel/panel_style.h"
#include "viewer/panel/widgets.h"

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

/// The fiducials that wall.yaml names, and which of them are seen.
std::string markerText(const calib::Wall& wall, const CameraPicture& picture) {
  std::size_t wanted = 0;
  std::string missing;
  for (const auto& fiducial : wall.surface.fiducials) {
    if (!fiducial.aruco) continue;
    ++wanted;
    if (!picture.markers.contains(*fiducial.aruco)) missing += " " + std::to_string(*fiducial.aruco);
  }
  if (wanted == 0) return fmt::format("{} markers", picture.markers.size());
  return fmt::format("{} of {} fiducials{}", wanted - static_cast<std::size_t>(std::ranges::count(missing, ' ')),
                     wanted, missing.empty() ? "" : ", missing:" + missing);
}

/// Under a marker, readable on a bright wall too.
void drawLabel(ImDrawList& list, ImVec2 centre, float radius, const std::string& text, std::uint32_t colour) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 at = {centre.x - size.x / 2, centre.y + radius + 3 * panelScale()};
  list.AddRectFilled({at.x - 4 * panelScale(), at.y}, {at.x + size.x + 4 * panelScale(), at.y + size.y}, Colours::kBack,
                     3 * panelScale());
  list.AddText(at, colour, text.c_str());
}

}  // namespace

void CameraView::upload(const CameraPicture& picture) {
  uploaded_ = picture.number;
  if (picture.photo.empty()) return;
  texture_ = devices::GlTexture::create(GL_TEXTURE_2D);
  glTextureStorage2D(texture_.get(), 1, GL_RGB8, picture.photo.width(), picture.photo.height());
  glTextureParameteri(texture_.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_.get(), 0, 0, 0, picture.photo.width(), picture.photo.height(),
                      picture.photo.channels() == 1 ? GL_RED : GL_RGB, GL_UNSIGNED_BYTE,
                      picture.photo.samples().data());
}

void CameraView::draw(PanelContext& panel) {
  const auto picture = feed_.latest();
  if (panel.longJob() != nullptr) dimText("The live picture rests while something else may need the camera.");
  if (picture->number != uploaded_) upload(*picture);
  if (picture->number == 0) return dimText("Waiting for the camera's first picture…");
  if (!picture->trouble.empty()) return wrappedText(Colours::kBad, picture->trouble);
  dimText(fmt::format("{} × {} pixels, {:.1f} s a picture, {}", picture->size.width, picture->size.height,
                      picture->seconds, markerText(*panel.wall->wall, *picture)));
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float scale =
      std::min(room.x / static_cast<float>(picture->size.width), room.y / static_cast<float>(picture->size.height));
  if (scale <= 0) return;
  const ImVec2 size = {scale * static_cast<float>(picture->size.width),
                       scale * static_cast<float>(picture->size.height)};
  const ImVec2 at = ImGui::GetCursorScreenPos();
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the toolkit's way to name a texture
  ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.get())), size);
  panel.map.add("camera-picture");
  drawMarkers(panel, *picture, {at.x, at.y}, scale);
}

void CameraView::drawMarkers(const PanelContext& panel, const CameraPicture& picture, glm::vec2 at, float scale) const {
  std::set<int> wanted;
  for (const auto& fiducial : panel.wall->wall->surface.fiducials) {
    if (fiducial.aruco) wanted.insert(*fiducial.aruco);
  }
  ImDrawList* const list = ImGui::GetWindowDrawList();
  for (const auto& [id, pointInPhoto] : picture.markers) {
    const ImVec2 centre = {at.x + scale * static_cast<float>(pointInPhoto.x),
                           at.y + scale * static_cast<float>(pointInPhoto.y)};
    const auto colour = wanted.empty() || wanted.contains(id) ? Colours::kGood : Colours::kWarn;
    const float radius = 9 * panelScale();
    list->AddCircle(centre, radius, colour, 0, 2 * panelScale());
    drawLabel(*list, centre, radius, std::to_string(id), colour);
  }
}

}  // namespace pixelflex::viewer
