#include "tests/support_calibration/coordinate_desktop.h"

#include "devices/display/gl_context.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::calib {

std::vector<devices::ImageF> showCoordinates(const Rig& rig, const viewer::WallPlan& wall) {
  devices::HeadlessContext context;
  viewer::WallRenderer renderer(context, {.measure = true});
  renderer.setPlans(wall.outputsFor(wall.desktop()));
  devices::ImageF desktop(wall.desktop(), 4);
  for (int y = 0; y < desktop.height(); ++y) {
    for (int x = 0; x < desktop.width(); ++x) {
      desktop.at(x, y, 0) = static_cast<float>(x + 0.5);
      desktop.at(x, y, 1) = static_cast<float>(y + 0.5);
    }
  }
  renderer.uploadDesktop(desktop);
  renderer.draw();
  std::vector<devices::ImageF> shown(rig.projectors.size());
  for (std::size_t output = 0; output < renderer.outputCount(); ++output) {
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (rig.projectors[i].name == renderer.outputName(output)) shown[i] = renderer.readOutputFloat(output);
    }
  }
  return shown;
}

}  // namespace pixelflex::calib
