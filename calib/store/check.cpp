#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "calib/store/preset.h"
#include "calib/store/readings_file.h"
#include "calib/store/store.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/image_error.h"
#include "devices/image/png_file.h"
#include "devices/projector_control/device_factory.h"
#include "devices/transport/line_address.h"

namespace pixelflex::calib {
namespace {

using Node = YamlReader::Node;
using Problems = std::vector<Problem>;

void append(Problems& problems, const Problems& more) {
  problems.insert(problems.end(), more.begin(), more.end());
}

/// What `action` throws, as problems.
void collect(Problems& problems, const std::function<void()>& action) {
  try {
    action();
  } catch (const StoreError& error) {
    append(problems, error.problems());
  } catch (const std::runtime_error& error) {
    problems.push_back({"", 0, 0, error.what()});  // names its file
  }
}

/// The files that wall.yaml and calibration.yaml name are looked at through their nodes, so that a missing one is
/// reported where it is named.
class Checker {
 public:
  Checker(const std::filesystem::path& folder, Problems& problems) : folder_(folder), problems_(problems) {}

  void checkReadingsAt(const Node& node) {
    if (exists(node)) collect(problems_, [&] { append(problems_, checkReadings(folder_ / node.text())); });
  }

  /// Without a resolution it may be any.
  void checkMaskAt(const Node& node, const std::optional<devices::Size>& wanted) {
    if (!node.defined() || !exists(node)) return;
    const std::filesystem::path path = folder_ / node.text();
    collect(problems_, [&] {
      const devices::Image16 mask = devices::readPng16(path);
      const devices::Size resolution = wanted.value_or(mask.size());
      if (!(mask.size() == resolution)) {
        addFile(path, "the mask is " + text(mask.size()) + ", its projector " + text(resolution));
      }
      if (mask.channels() != 1 || bitDepth(path) != 16) addFile(path, "a mask is a 16-bit grey PNG");
    });
  }

  /// A device's driver and address, and its password's file.
  void checkDeviceAt(const Node& node, bool mirror) {
    if (!node.defined()) return;
    const Node driver = node.optional("driver");
    const auto known = devices::deviceDrivers();
    const bool exists = std::ranges::find(known, driver.text()) != known.end();
    if (!exists || devices::isPanTiltDriver(driver.text()) != mirror) {
      driver.problem(mirror ? "a mirror's driver is ptu"
                            : "there is no such driver of projectors: " + projectors(known));
    }
    try {
      (void)devices::parseLineAddress(node.optional("at").text());
    } catch (const std::invalid_argument& error) {
      node.optional("at").problem(error.what());
    }
    if (const Node file = node.optional("password_file"); file.defined()) (void)this->exists(file);
  }

  bool exists(const Node& node) {
    if (!node.isScalar()) return false;
    if (std::filesystem::is_regular_file(folder_ / node.text())) return true;
    node.problem("there is no file " + (folder_ / node.text()).string());
    return false;
  }

  static std::string text(devices::Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

 private:
  static std::string projectors(const std::vector<std::string>& drivers) {
    std::string list;
    for (const auto& name : drivers) {
      if (!devices::isPanTiltDriver(name)) list += (list.empty() ? "" : ", ") + name;
    }
    return list;
  }

  void addFile(const std::filesystem::path& path, const std::string& message) {
    problems_.push_back({path.string(), 0, 0, message});
  }

  static int bitDepth(const std::filesystem::path& path) {
    constexpr std::size_t kPlace = 24;  // signature, length and name of the header chunk, width, height
    const std::string bytes = readStoreFile(path.string());
    return bytes.size() > kPlace ? static_cast<unsigned char>(bytes[kPlace]) : 0;
  }

  const std::filesystem::path& folder_;
  Problems& problems_;
};

void checkWallFiles(const std::filesystem::path& folder, const Wall& wall, Problems& problems) {
  const auto path = (folder / "wall.yaml").string();
  const YamlReader reader(readStoreFile(path), path);
  Checker checker(folder, problems);
  const Node list = reader.root().optional("projectors");
  for (std::size_t i = 0; i < wall.projectors.size(); ++i) {
    const Node gamma = list.at(i).optional("gamma");
    checker.checkDeviceAt(list.at(i).optional("control"), false);
    checker.checkDeviceAt(list.at(i).optional("mirror"), true);
    if (!wall.projectors[i].gammaByCamera) checker.checkReadingsAt(gamma);
    if (wall.projectors[i].gammaByCamera && wall.camera.source == "none") {
      gamma.problem("gamma: camera needs a camera, and there is none (source: none)");
    }
  }
  (void)checker.exists(reader.root().optional("rig"));
  append(problems, reader.problems());
}

void checkAgreement(const Node& node, const ProjectorCalibration& projector, const Wall& wall) {
  const auto config = std::ranges::find(wall.projectors, projector.name, &ProjectorConfig::name);
  if (config == wall.projectors.end()) {
    node.optional("name").problem("wall.yaml has no projector " + projector.name);
  } else if (!(config->resolution == projector.resolution)) {
    node.optional("resolution")
        .problem("wall.yaml says " + Checker::text(config->resolution) + ": run pixelflex calibrate WALL again");
  } else if (config->flatAt != projector.flatAt) {
    node.problem(R"(its "flat" differs from wall.yaml's)");
  }
}

void checkCalibrationFiles(const std::filesystem::path& folder, const Calibration& calibration,
                           const std::optional<Wall>& wall, Problems& problems) {
  const auto path = (folder / "calibration.yaml").string();
  const YamlReader reader(readStoreFile(path), path);
  Checker checker(folder, problems);
  checker.checkReadingsAt(reader.root().optional("camera").optional("response"));
  const Node list = reader.root().optional("projectors");
  for (std::size_t i = 0; i < calibration.projectors.size(); ++i) {
    const auto& projector = calibration.projectors[i];
    checker.checkMaskAt(list.at(i).optional("alpha"), projector.resolution);
    checker.checkReadingsAt(list.at(i).optional("response"));
    if (projector.light) {
      checker.checkMaskAt(list.at(i).optional("light").optional("gain"), std::nullopt);
      checker.checkMaskAt(list.at(i).optional("light").optional("black"), projector.resolution);
    }
    if (wall) checkAgreement(list.at(i), projector, *wall);
  }
  for (std::size_t i = 0; wall && i < wall->projectors.size(); ++i) {
    const std::string& name = wall->projectors[i].name;
    if (calibration.find(name) == nullptr) {
      list.problem("projector " + name + " is not calibrated: run pixelflex calibrate WALL");
    }
  }
  append(problems, reader.problems());
}

void checkPresets(const std::filesystem::path& folder, Problems& problems) {
  std::vector<std::string> names;
  collect(problems, [&] { names = presetNames(folder); });
  for (const auto& name : names) {
    collect(problems, [&] {
      const Preset preset = loadPreset(folder, name);
      if (!preset.calibration || hasCalibration(folder / *preset.calibration)) return;
      problems.push_back({(folder / "presets" / (name + ".yaml")).string(), 0, 0,
                          "its calibration " + *preset.calibration + " is gone: save the preset again, or delete it"});
    });
  }
}

}  // namespace

std::vector<Problem> checkWall(const std::filesystem::path& folder) {
  Problems problems;
  std::optional<Wall> wall;
  collect(problems, [&] {
    wall = loadWall(folder);
    checkWallFiles(folder, *wall, problems);
  });
  checkPresets(folder, problems);
  if (!hasCalibration(folder)) return problems;
  collect(problems, [&] { checkCalibrationFiles(folder, loadCalibration(folder), wall, problems); });
  return problems;
}

}  // namespace pixelflex::calib
