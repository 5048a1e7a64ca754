#include "calib/capture/photographs.h"

#include "calib/patterns/blob_pattern.h"
#include "devices/image/atomic_file.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

std::vector<ProjectedPattern> patternsFor(devices::Size size) {
  std::vector<ProjectedPattern> patterns;
  for (const Pattern pattern : allPatterns()) patterns.push_back(projected(pattern, BlobLayout(size)));
  return patterns;
}

std::string instructions(const std::vector<std::pair<std::string, devices::Size>>& projectors) {
  std::string text =
      "How to photograph the wall for PixelFlex\n"
      "========================================\n\n"
      "Before you start\n"
      "- Put the camera on a tripod so that it sees the whole lit wall and all markers. Do not touch it afterwards.\n"
      "- Fix focus, zoom, exposure, ISO and white balance by hand. Automatic anything spoils the measurement.\n"
      "- Set the exposure from white.png on the brightest projector: white must stay below about 85 % of the scale.\n"
      "- Save as PNG, or JPEG of the best quality, at the camera's full size.\n\n"
      "Make a new folder, say photos/, and put into it\n"
      "1. checkerboard/1.png, checkerboard/2.png, ...: about 15 photographs of the checkerboard, lights on, tilted up "
      "to\n"
      "   40 degrees this way and that, in all parts of the picture. (Or a file camera.yaml with known intrinsics:\n"
      "   size, fx, fy, cx, cy, radial, tangential as in calibration.yaml.)\n"
      "2. fiducials.png: the wall with its markers, lights on, all projectors black.\n"
      "3. With the lights out, for every file here: show it full screen on its projector, one picture pixel to one\n"
      "   projector pixel, all other projectors black, and save the photograph under the same name:\n\n";
  for (const auto& [name, size] : projectors) {
    text += "   " + name + " (" + std::to_string(size.width) + "x" + std::to_string(size.height) + ")\n";
    for (const auto& pattern : patternsFor(size)) {
      text += "     " + patternPath(name, pattern).string() + ".png    " + pattern.description + "\n";
    }
  }
  return text + "\nThen run: pixelflex calibrate WALL --photos photos/\n";
}

}  // namespace

std::filesystem::path patternPath(const std::string& projector, const ProjectedPattern& pattern) {
  return std::filesystem::path(projector) / pattern.name;
}

void writePatterns(const std::filesystem::path& folder,
                   const std::vector<std::pair<std::string, devices::Size>>& projectors) {
  for (const auto& [name, size] : projectors) {
    for (const auto& pattern : patternsFor(size)) {
      writePng(folder / (patternPath(name, pattern).string() + ".png"), pattern.render());
    }
  }
  devices::writeFileAtomically(folder / "README.txt", instructions(projectors));
}

}  // namespace pixelflex::calib
