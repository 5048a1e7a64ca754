#include "calib/capture/photographs.h"

#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

const char* const kBefore = R"(How to photograph the wall for PixelFlex
========================================

Before you start
- Put the camera on a tripod so that it sees the whole lit wall and all markers. Do not touch it afterwards.
- Fix focus, zoom, exposure, ISO and white balance by hand. Automatic anything spoils the measurement.
- Set the exposure from WHITE.png on the brightest projector: white must stay below about 85 % of the scale.
- Save as PNG, or JPEG of the best quality, at the camera's full size.

Make a new folder, say photos/, and put into it
1. checkerboard/1.png, checkerboard/2.png, ...: about 15 photographs of the checkerboard, lights on, tilted up to
   40 degrees this way and that, in all parts of the picture. (Or a file camera.yaml with known intrinsics:
   size, fx, fy, cx, cy, radial, tangential as in calibration.yaml.)
2. fiducials.png: the wall with its markers, lights on, all projectors black.
3. With the lights out, for every file here: show it full screen on its projector, one picture pixel to one
   projector pixel, all other projectors black, and save the photograph under the same name:

)";

const char* const kAfter = R"(
Then run: pixelflex calibrate WALL --photos photos/METHOD

If one picture cannot hold the wall
- Photograph it from several places, each into a folder of its own: photos/left/, photos/middle/, photos/right/, with
  fiducials.png and the projectors' folders as above. The photographs of the checkerboard are needed once.
- From each place photograph all patterns of every projector that is wholly in the picture, and only of those. Every
  projector must be wholly in the pictures of at least one place.
- Neighbouring pictures overlap by 40 to 60 % and share two projectors or more.
- At least four markers in all, spread over the wall, and some in most pictures. A place that sees none needs no
  fiducials.png.
- Between the places move the camera only: zoom, focus and exposure stay as they are.
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

std::string instructions(const std::vector<ProjectorPatterns>& projectors, Method method) {
  const bool dense = method == Method::kDense;
  std::string text = replaced(kBefore, "WHITE", dense ? "dense-white" : "white");
  for (const auto& [name, size, patterns] : projectors) {
    text += "   " + name + " (" + std::to_string(size.width) + "x" + std::to_string(size.height) + ")\n";
    for (const auto& pattern : patterns) {
      text += "     " + patternPath(name, pattern).string() + ".png    " + pattern.description + "\n";
    }
  }
  return text + replaced(kAfter, "METHOD", dense ? " --method " + methodName(method) : "");
}

}  // namespace

std::filesystem::path patternPath(const std::string& projector, const ProjectedPattern& pattern) {
  return std::filesystem::path(projector) / pattern.name;
}

void writePatterns(const std::filesystem::path& folder, const std::vector<ProjectorPatterns>& projectors,
                   Method method) {
  for (const auto& [name, size, patterns] : projectors) {
    for (const auto& pattern : patterns) {
      writePng(folder / (patternPath(name, pattern).string() + ".png"), pattern.render());
    }
  }
  devices::writeFileAtomically(folder / "README.txt", instructions(projectors, method));
}

}  // namespace pixelflex::calib
