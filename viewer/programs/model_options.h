#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "viewer/model/model_view.h"
#include "viewer/model/stereo_picture.h"
#include "viewer/plan/model_wall.h"

namespace pixelflex::viewer {

/// Where one pass looks up the codes of a projector's device: in its output's own table, where there is one, or at the
/// end of the drawing. kRamp insists on the first.
enum class LookUp { kAuto, kRamp, kPass };

/// The command line of `pixelflex model`.
struct ModelCommand {
  std::string wall;
  std::vector<std::filesystem::path> files;
  bool headless = false;
  std::optional<std::string> screenshot;  // folder
  int turntable = 0;                      // frames of one turn; 0: none
  std::vector<std::string> projectors;    // empty: all
  ModelWallOptions draw;
  LookUp lookUp = LookUp::kAuto;
  StereoKind stereo = StereoKind::kOff;
  ModelPose pose;
  std::optional<glm::dvec3> eye;  // window's frame; none: centred
  std::optional<double> eyeDistance;
  std::optional<glm::dvec4> cut;
  bool preview = false;  // a window of the whole desktop beside the wall
  bool room = false;     // what the audience of a simulated wall sees, as a picture or in a window
  bool track = false;    // the viewer's place comes from standard input
  bool wireframe = false;
  bool axes = false;
};

/// Numbers with commas between, `least` to `most` of them. Throws std::invalid_argument, which names `option`.
[[nodiscard]] std::vector<double> parseNumbers(const std::string& option, const std::string& text, std::size_t least,
                                               std::size_t most);

/// What the command line says of the view, before anybody moves it.
[[nodiscard]] ModelView viewOf(const ModelCommand& command, const WallWindow& window);

}  // namespace pixelflex::viewer
