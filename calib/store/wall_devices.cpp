#include "calib/store/wall_devices.h"

#include <string_view>

#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

/// `serial:line1` is a file of the wall's folder.
std::string resolved(const std::string& address, const std::filesystem::path& folder) {
  constexpr std::string_view kSerial = "serial:";
  const bool relative = address.starts_with(kSerial) && address.size() > kSerial.size() && address[7] != '/';
  if (!relative) return address;
  return std::string(kSerial) + (std::filesystem::absolute(folder) / address.substr(kSerial.size())).string();
}

}  // namespace

std::vector<WallDevice> devicesOf(const Wall& wall, const std::filesystem::path& folder) {
  std::vector<WallDevice> found;
  for (const auto& projector : wall.projectors) {
    for (const bool mirror : {false, true}) {
      const auto& line = mirror ? projector.mirror : projector.control;
      if (!line) continue;
      WallDevice device{projector.name + (mirror ? ".mirror" : ".control"), projector.name, mirror, *line};
      device.line.at = resolved(line->at, folder);
      if (auto& file = device.line.passwordFile) file = (folder / *file).string();
      found.push_back(std::move(device));
    }
  }
  return found;
}

std::string passwordOf(const WallDevice& device) {
  if (!device.line.passwordFile) return "";
  std::string text = readStoreFile(*device.line.passwordFile);
  return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace pixelflex::calib
