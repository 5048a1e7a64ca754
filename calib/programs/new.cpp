// pixelflex new WALL: makes the folder of a wall, from the monitors found, from a simulated rig, or flat.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib/programs/command_line.h"
#include "calib/programs/new_wall.h"
#include "calib/simulate/rig.h"
#include "calib/store/yaml_reader.h"
#include "devices/display/event_loop.h"
#include "devices/display/monitors.h"

namespace {

namespace calib = pixelflex::calib;

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

void checkGrid(const std::string& flat) try {
  (void)calib::parseFlatGrid(flat);
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(std::string("--flat ") + error.what());
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

int main(int argc, char** argv) {
  CLI::App app("Makes the folder of a wall with a commented wall.yaml: from the monitors found, or with an option.",
               "pixelflex new");
  Options options;
  app.add_option("WALL", options.wall, "The folder to make")->required();
  auto* rig = app.add_option("--rig", options.rig, "A simulated wall with the optics of this file");
  app.add_option("--flat", options.flat, "Screens that show the desktop one to one: [COLSxROWS:]WxH")->excludes(rig);
  const auto parse = [&] {
    app.parse(argc, argv);
    if (options.flat) checkGrid(*options.flat);
  };
  return calib::runCommand(app, parse, [&] {
    make(options);
    return 0;
  });
}
