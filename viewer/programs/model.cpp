// pixelflex model WALL FILE...: 3D models on the wall, in one pass for each projector.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "calib/programs/command_line.h"
#include "calib/store/store.h"
#include "viewer/model/scene_file.h"
#include "viewer/programs/model_headless.h"
#include "viewer/programs/model_options.h"
#include "viewer/programs/model_windows.h"

namespace pixelflex::viewer {
namespace {

const std::map<std::string, Features> kFeatures{{"all", Features::kAll}, {"corners", Features::kCorners}};
const std::map<std::string, StereoKind> kStereo{
    {"off", StereoKind::kOff}, {"side-by-side", StereoKind::kSideBySide}, {"anaglyph", StereoKind::kAnaglyph}};

const std::map<std::string, LookUp> kLookUps{{"auto", LookUp::kAuto}, {"ramp", LookUp::kRamp}, {"pass", LookUp::kPass}};

/// Options that are lists of numbers.
struct Texts {
  std::string view;
  std::string eye;
  std::string cut;
  std::string lens = "none";
};

void addDrawing(CLI::App& app, ModelCommand& command, Texts& texts) {
  app.add_option(
         "--passes", command.draw.passes,
         "1: straight to each projector by a 4x4 matrix; 2: once for the desktop, which is then warped as exactly "
         "as any desktop")
      ->check(CLI::IsMember({1, 2}))
      ->capture_default_str();
  calib::takeOneOf(
      app.add_option("--fit", command.draw.features,
                     "features that the matrix of one pass is fitted to: all, or the four corners; else all")
          ->option_text("all|corners"),
      kFeatures);
  app.add_option("--lens", texts.lens,
                 "vertex: one pass makes up for the lens at each corner of a triangle, right where triangles are small")
      ->check(CLI::IsMember({"none", "vertex"}))
      ->capture_default_str();
  calib::takeOneOf(
      app.add_option(
             "--lut", command.lookUp,
             "where windows of one pass look up a projector's codes: in its output's own gamma ramp (RandR), which "
             "is given back at the end, or in a last pass; else in the ramp where there is one")
          ->option_text("auto|ramp|pass"),
      kLookUps);
  app.add_option("--samples", command.draw.model.samples, "of each pixel, to smooth edges; 1: they are not")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  calib::takeOneOf(
      app.add_option(
             "--stereo", command.stereo,
             "desktop.png and the preview with both eyes' pictures; a wall with stack: left-right shows them itself")
          ->option_text("off|side-by-side|anaglyph"),
      kStereo);
}

void addView(CLI::App& app, ModelCommand& command, Texts& texts) {
  app.add_option(
      "--view", texts.view,
      "YAW,PITCH[,ZOOM[,X,Y,Z]]: degrees, times the size that fits, and the model's middle in shorter sides of "
      "the display from its middle: right, up, towards the audience");
  app.add_option(
      "--eye", texts.eye,
      "X,Y,Z of the viewer in wall units from the display's middle: right, up, towards the audience; the wall "
      "is then a window. Else its middle, 1.2 times its longer side away");
  app.add_option("--eye-distance", command.eyeDistance,
                 "between the two eyes, wall units; else 1/40 of the way to the wall")
      ->check(CLI::NonNegativeNumber);
  app.add_option(
      "--cut", texts.cut,
      "NX,NY,NZ,D: show only what lies before this plane, where NX*X + NY*Y + NZ*Z + D is positive, places as "
      "for --eye");
  app.add_flag("--wireframe", command.wireframe, "edges instead of surfaces");
  app.add_flag("--axes", command.axes, "the model's axes: x red, y green, z blue");
}

void take(const Texts& texts, ModelCommand& command) {
  command.draw.lensAtVertices = texts.lens == "vertex";
  if (!texts.view.empty()) {
    auto n = parseNumbers("--view", texts.view, 2, 6);
    if (n.size() == 4 || n.size() == 5)
      throw std::invalid_argument("--view " + texts.view + ": needs 2, 3 or 6 numbers");
    n.resize(6, 0);
    if (n[2] == 0) n[2] = 1;
    if (n[2] < 0) throw std::invalid_argument("--view " + texts.view + ": the zoom must be positive");
    command.pose = {.yaw = n[0], .pitch = n[1], .zoom = n[2], .shift = {n[3], n[4], n[5]}};
  }
  if (!texts.eye.empty()) {
    const auto n = parseNumbers("--eye", texts.eye, 3, 3);
    if (n[2] <= 0) throw std::invalid_argument("--eye " + texts.eye + ": Z must be positive: before the wall");
    command.eye = glm::dvec3(n[0], n[1], n[2]);
  }
  if (!texts.cut.empty()) {
    const auto n = parseNumbers("--cut", texts.cut, 4, 4);
    command.cut = glm::dvec4(n[0], n[1], n[2], n[3]);
  }
}

int show(const ModelCommand& command) {
  const auto wall = std::make_shared<const WallPlan>(command.wall, calib::loadWall(command.wall),
                                                     calib::loadCalibration(command.wall), command.projectors);
  // First, while this process has no threads and no graphics that its readers would inherit.
  Scene scene = loadScene(command.files);
  for (const auto& warning : scene.warnings) fmt::print(stderr, "pixelflex-model: warning: {}\n", warning);
  return command.screenshot ? runModelHeadless(command, *wall, std::move(scene))
                            : runModelWindows(command, wall, std::move(scene));
}

void defineOptions(CLI::App& app, ModelCommand& command, Texts& texts) {
  app.add_option("WALL", command.wall, "the wall's folder")->required();
  app.add_option("FILE", command.files, "models, in common coordinates")->required();
  app.add_flag("--headless", command.headless, "draw without any window or X server (EGL)");
  app.add_option("--screenshot", command.screenshot, "write DIR/<projector>.png and DIR/desktop.png and exit");
  app.add_option("--turntable", command.turntable,
                 "turn the model once in so many steps; --screenshot's pictures of step N go into DIR/N")
      ->check(CLI::Range(1, 999));
  app.add_flag("--preview", command.preview, "a window of the whole desktop, also beside the wall");
  app.add_flag("--room", command.room,
               "what the audience of a simulated wall sees: a window, or DIR/room.png beside --screenshot's pictures");
  app.add_flag("--track", command.track,
               "the viewer's place comes from standard input, \"X Y Z\" a line, as for --eye; windows follow it");
  app.add_option("--projectors", command.projectors, "only these projectors")->delimiter(',');
  addDrawing(app, command, texts);
  addView(app, command, texts);
  app.footer(
      "In its windows: drag turns the model, with the right button or Shift it moves it, the wheel zooms; w s a d e q "
      "fly, "
      "arrows turn, f fits, Home goes back, l lines, x axes, c cuts (and [ ] move the cut), Escape or Ctrl+Alt+Q "
      "ends.");
}

void checkTogether(const ModelCommand& command) {
  if ((command.headless || command.turntable > 0) && !command.screenshot) {
    throw std::invalid_argument("--headless and --turntable need --screenshot DIR");
  }
  if (command.lookUp == LookUp::kRamp && (command.draw.passes != 1 || command.screenshot)) {
    throw std::invalid_argument("--lut ramp is for windows of one pass");
  }
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app("Shows 3D models on the wall: OBJ, PLY, STL, glTF and what else Assimp reads.", "pixelflex model");
  viewer::ModelCommand command;
  viewer::Texts texts;
  viewer::defineOptions(app, command, texts);
  const auto parse = [&] {
    app.parse(argc, argv);
    viewer::take(texts, command);
    viewer::checkTogether(command);
  };
  return calib::runCommand(app, parse, [&] { return viewer::show(command); });
}
