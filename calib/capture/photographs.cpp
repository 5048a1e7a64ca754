#include "calib/capture/photographs.h"

#include <algorithm>
#include <iterator>

#include "calib/patterns/response_pattern.h"
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

const char* const kResponse = R"(
The response of PROJECTORS
- Where wall.yaml says gamma: camera there are also full fields of red, green and blue at 32 levels (red-008 to
  blue-255), response-black and response-chart. They are photographed like the others, but at several exposure times;
  nothing else about the camera changes. With the usual time U (set from WHITE.png) and multiples of it:
     levels from 128 on                            U
     levels 56 to 120                              4 times U
     levels 32 to 48                               16 times U
     levels 8 to 24, response-black                64 times U
     response-chart, if the camera is not linear   nine photographs: U/4, U/2, U, 2 U, 4 U ... 64 U
  One more photograph of a level, at another time, makes it surer. If one is over-exposed, take a shorter time.
- Say the exposure time in seconds after an @ in the name: red-128@1_60.jpg for a sixtieth, red-008@2.jpg, or
  red-008@0.5.png. A JPEG straight from the camera holds its exposure time, so red-128.jpg is enough there, and
  red-128@a.jpg, red-128@b.jpg for several of one pattern.
- Cameras round the times that they show: 1/15, 1/30, 1/60 and 1/125 mostly mean 1_16, 1_32, 1_64 and 1_128, 15 and 30
  seconds 16 and 32. Write what is meant: six per cent wrong would show.
- response-chart is needed of one projector only, and not at all when wall.yaml says camera: {transfer: linear} or
  {transfer: srgb}. Without it the camera counts as linear, as raw photographs are.
- A linear camera may photograph everything once, without any @; then the dark levels are less sure, and the result
  says by how much.
- response-ambient, if it can be taken (the projector switched off or its lens covered, 64 times U): tells how much
  light the projector's black leaks.
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

bool showsResponse(const ProjectorPatterns& projector) {
  return std::ranges::any_of(projector.patterns, [](const auto& pattern) { return isOfResponse(pattern.name); });
}

std::string responseInstructions(const std::vector<ProjectorPatterns>& projectors, const std::string& white) {
  std::string names;
  for (const auto& projector : projectors) {
    if (showsResponse(projector)) names += (names.empty() ? "" : ", ") + projector.name;
  }
  return names.empty() ? "" : replaced(replaced(kResponse, "PROJECTORS", names), "WHITE", white);
}

std::string instructions(const std::vector<ProjectorPatterns>& projectors, Method method) {
  const bool dense = method == Method::kDense;
  const std::string white = dense ? "dense-white" : "white";
  std::string text = replaced(kBefore, "WHITE", white);
  for (const auto& [name, size, patterns] : projectors) {
    text += "   " + name + " (" + std::to_string(size.width) + "x" + std::to_string(size.height) + ")\n";
    for (const auto& pattern : patterns) {
      text += "     " + patternPath(name, pattern).string() + ".png    " + pattern.description + "\n";
    }
  }
  text += responseInstructions(projectors, white);
  return text + replaced(kAfter, "METHOD", dense ? " --method " + methodName(method) : "");
}

}  // namespace

std::filesystem::path patternPath(const std::string& projector, const ProjectedPattern& pattern) {
  return std::filesystem::path(projector) / pattern.name;
}

Photographs::Exposed Photographs::exposed(const std::string& projector, const ProjectedPattern& pattern, double,
                                          const PictureRegion&) {
  return {patternPath(projector, pattern).string(), std::nullopt, this->pattern(projector, pattern)};
}

std::vector<Photographs::Exposed> Photographs::exposures(const std::string& projector, const std::string& pattern) {
  throw CaptureError(projector + "/" + pattern + ": there are no photographs at other exposures here");
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
