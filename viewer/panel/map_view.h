#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/panel/aim_book.h"
#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// The wall as the audience sees it, with the footprints of the projectors as calibrated. A footprint that is dragged
/// aims its mirror. Main thread.
class MapView {
 public:
  explicit MapView(std::filesystem::path folder) : book_(std::move(folder)) {}
  void draw(PanelContext& panel);
  /// Every frame, whether the map is seen or not.
  void update(const WallSnapshot& wall) { book_.update(wall); }

 private:
  struct Footprint {
    std::string projector;
    std::size_t index = 0;            // in wall.yaml
    std::vector<glm::dvec2> outline;  // wall units
    glm::dvec2 centre{0, 0};
  };
  /// Window pixels from wall units.
  struct View {
    glm::dvec2 wallAt{0, 0};
    glm::dvec2 windowAt{0, 0};
    double scale = 1;
    [[nodiscard]] glm::vec2 operator()(glm::dvec2 pointInWall) const {
      return glm::vec2(windowAt + scale * (pointInWall - wallAt));
    }
  };
  struct Drag {
    std::string projector;
    glm::dvec2 from{0, 0};  // window pixels
    glm::dvec2 by{0, 0};    // wall units
  };

  void measure(const WallSnapshot& wall);
  [[nodiscard]] View viewIn(glm::dvec2 topLeft, glm::dvec2 size) const;
  [[nodiscard]] const Footprint* footprintAt(glm::dvec2 pointInWall) const;
  void takePointer(PanelContext& panel, const View& view);
  void aim(PanelContext& panel, const Drag& drag);
  void drawWall(const PanelContext& panel, const View& view) const;
  void drawFootprint(PanelContext& panel, const View& view, const Footprint& footprint) const;
  void drawRemarks(const PanelContext& panel) const;

  AimBook book_;
  std::shared_ptr<const calib::Calibration> measured_;  // what the footprints are of
  std::vector<Footprint> footprints_;
  glm::dvec2 topLeft_{0, 0};  // of all that is drawn, wall units
  glm::dvec2 bottomRight_{1, 1};
  std::optional<Drag> drag_;
  std::map<std::string, glm::dvec2> aimed_;  // since the calibration, wall units: where footprints will be by now
};

}  // namespace pixelflex::viewer
