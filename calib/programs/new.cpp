// pixelflex new WALL: makes the folder of a wall, from the monitors found, from a simulated rig, or flat.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/programs/new_wall.h"
#include "calib/simulate/rig.h"
#include "calib/store/yaml_reader.h"
#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"

namespace {

namespace calib = pixelflex::calib;

constexpr int kWrongUsage = 2;

struct Options {
  std::string wall;
  std::optional<std::string> rig;
  std::optional<std::string> flat;
};

std::vector<calib::FoundMonitor> foundMonitors() {
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') {
    throw std::runtime_error("no display to look for monitors on: set DISPLAY, or use --rig or --flat");
  }
  const pixelflex::devices::EventLoop loop;
  std::vector<calib::FoundMonitor> found;
  for (const auto& monitor : pixelflex::devices::listMonitors(loop)) found.push_back({monitor.name, monitor.size});
  if (found.empty()) {
    throw std::runtime_error(std::string(display) +
                             ": no monitor is switched on; switch one on, or use --rig or --flat");
  }
  return found;
}

std::vector<calib::NewFile> filesOf(const Options& options) {
  if (options.flat) return calib::filesOfFlatWall(calib::parseFlatGrid(*options.flat));
  if (options.rig) {
    const std::string text = calib::readStoreFile(*options.rig);
    return calib::filesOfRig(calib::parseRig(text, *options.rig), text);
  }
  return calib::filesOfMonitors(foundMonitors());
}

void make(const Options& options) {
  const auto files = filesOf(options);
  calib::makeWallFolder(options.wall, files);
  std::cout << options.wall << ": made";
  for (const auto& file : files) std::cout << ' ' << file.path.string();
  std::cout << '\n';
  if (options.flat) {
    std::cout << "Next: pixelflex view " << options.wall << " SERVER\n";
  } else {
    std::cout << "Look through " << options.wall << "/wall.yaml, then: pixelflex calibrate " << options.wall << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Makes the folder of a wall with a commented wall.yaml: from the monitors found, or with an option.",
               "pixelflex new");
  Options options;
  app.add_option("WALL", options.wall, "The folder to make")->required();
  auto* rig = app.add_option("--rig", options.rig, "A simulated wall with the optics of this file");
  app.add_option("--flat", options.flat, "Screens that show the desktop one to one: [COLSxROWS:]WxH")->excludes(rig);
  app.set_version_flag("--version", "pixelflex-new " PIXELFLEX_VERSION);
  try {
    app.parse(argc, argv);
    if (options.flat) (void)calib::parseFlatGrid(*options.flat);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    std::cerr << "pixelflex-new: " << error.what() << "; see pixelflex new --help\n";
    return kWrongUsage;
  } catch (const std::invalid_argument& error) {
    std::cerr << "pixelflex-new: --flat " << error.what() << '\n';
    return kWrongUsage;
  }
  make(options);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "pixelflex-new: " << error.what() << '\n';
  return 1;
}
