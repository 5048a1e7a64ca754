// pixelflex camera list|shot: the cameras there are, and a photograph from one.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "calib/programs/command_line.h"
#include "calib/simulate/simulated_wall.h"
#include "calib/store/store.h"
#include "devices/camera/cameras.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string action;
  std::string from;
  std::string file = "shot.png";
  std::optional<double> exposure;
};

std::string sizeText(devices::Size size) {
  return size.width > 0 ? fmt::format("{}x{}", size.width, size.height) : "-";
}

int list() {
  const auto cameras = devices::listCameras();
  for (const auto& [address, model, size, why] : cameras) {
    fmt::print("{}  {}  {}{}\n", address, model, sizeText(size), why.empty() ? "" : "  (" + why + ")");
  }
  if (cameras.empty()) fmt::print("no camera was found\n");
  return 0;
}

/// A camera, with what must outlive it.
struct Opened {
  std::unique_ptr<SimulatedWall> room;
  std::unique_ptr<devices::Camera> own;
  [[nodiscard]] devices::Camera& camera() const { return room ? room->camera() : *own; }
};

Opened open(const std::string& from) {
  if (!fs::is_directory(from)) return {nullptr, devices::openCamera(from)};
  const Wall wall = loadWall(from);
  if (wall.camera.source != "sim") return {nullptr, devices::openCamera(wall.camera.source)};
  return {std::make_unique<SimulatedWall>(loadRig(fs::path(from) / *wall.rig)), nullptr};
}

double secondsSet(devices::Camera& camera, const std::string& from, double seconds) {
  auto* control = camera.exposureControl();
  if (control == nullptr) throw std::runtime_error(from + ": the exposure of this camera cannot be set from here");
  return control->setExposure(seconds);
}

int shot(const Arguments& arguments) {
  const Opened opened = open(arguments.from);
  devices::Camera& camera = opened.camera();
  if (arguments.exposure) (void)secondsSet(camera, arguments.from, *arguments.exposure);
  const devices::Image8 photo = camera.shoot();
  devices::writePng(arguments.file, photo);
  auto* control = camera.exposureControl();
  fmt::print("{}: {}{}\n", arguments.file, sizeText(photo.size()),
             control == nullptr ? "" : fmt::format(", exposed for {:.4g} s", control->exposure()));
  return 0;
}

void defineOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("ACTION", arguments.action, "list or shot")->required()->check(CLI::IsMember({"list", "shot"}));
  app.add_option("FROM", arguments.from, "shot: a wall's folder, or a source such as aravis:first or v4l2:/dev/video0");
  app.add_option("-o,--output", arguments.file, "shot: the PNG to write")->capture_default_str();
  app.add_option("--exposure", arguments.exposure, "shot: exposure time in seconds")->check(CLI::Range(1e-6, 3600.0));
  app.footer(
      "list tells of each camera what to write behind \"source:\" in wall.yaml, its model, and its resolution where\n"
      "that is known without opening it. Automatic exposure, gain, white balance and focus are switched off.");
}

}  // namespace
}  // namespace pixelflex::calib

int main(int argc, char** argv) {
  using namespace pixelflex;
  CLI::App app("Lists the cameras there are, and takes a photograph with one.", "pixelflex camera");
  calib::Arguments arguments;
  calib::defineOptions(app, arguments);
  const auto parse = [&] {
    app.parse(argc, argv);
    if (arguments.action == "shot" && arguments.from.empty()) throw CLI::RequiredError("FROM");
  };
  return calib::runCommand(app, parse,
                           [&] { return arguments.action == "list" ? calib::list() : calib::shot(arguments); });
}
