#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "calib/store/nudge.h"
#include "calib/store/store_checks.h"
#include "calib/store/yaml_text.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

constexpr double kMostPixels = 2000;  // a nudge is small; a projector that moved by more is calibrated again

std::filesystem::path nudgeFile(const std::filesystem::path& folder) {
  return folder / "nudge.yaml";
}

Nudge readNudge(const YamlReader::Node& node) {
  Nudge nudge;
  if (const auto shift = node.optional("shift"); shift.defined()) {
    const auto xy = shift.numbers(2, -kMostPixels, kMostPixels);
    nudge.shift = {xy[0], xy[1]};
  }
  if (const auto roll = node.optional("roll"); roll.defined()) nudge.roll = roll.number(-180, 180);
  if (const auto corners = node.optional("corners"); corners.defined()) {
    const auto elements = corners.elements(4, 4);
    for (std::size_t i = 0; i < std::min<std::size_t>(4, elements.size()); ++i) {
      const auto xy = elements[i].numbers(2, -kMostPixels, kMostPixels);
      nudge.corners[i] = {xy[0], xy[1]};
    }
  }
  return nudge;
}

}  // namespace

Nudges parseNudges(std::string_view text, const std::string& file) {
  YamlReader reader(text, file);
  reader.readHeader("pixelflex-nudge", kNudgeVersion);
  const auto root = reader.root();
  Nudges nudges;
  const auto projectors = root.required("projectors");
  for (const auto& node : projectors.elements(0, kMaxProjectors)) {
    const std::string name = readName(node.required("name"));
    nudges[name] = readNudge(node);
    node.refuseUnknownKeys();
  }
  checkUniqueNames(projectors);
  root.refuseUnknownKeys();
  reader.throwIfProblems();
  return nudges;
}

std::string formatNudges(const Nudges& nudges) {
  std::string text =
      "# Corrections by hand on top of the calibration, in projector pixels and degrees. Written by pixelflex "
      "calibrate.\n"
      "format: pixelflex-nudge\nversion: 1\nprojectors:\n";
  for (const auto& [name, nudge] : nudges) {
    std::string corners;
    for (const auto& corner : nudge.corners) corners += (corners.empty() ? "" : ", ") + yamlList({corner.x, corner.y});
    text += fmt::format("  - {{name: {}, shift: {}, roll: {}, corners: [{}]}}\n", yamlText(name),
                        yamlList({nudge.shift.x, nudge.shift.y}), yamlNumber(nudge.roll), corners);
  }
  return text;
}

Nudges loadNudges(const std::filesystem::path& folder) {
  const auto path = nudgeFile(folder);
  if (!std::filesystem::exists(path)) return {};
  return parseNudges(readStoreFile(path.string()), path.string());
}

void saveNudges(const std::filesystem::path& folder, const Nudges& nudges) {
  if (nudges.empty()) {
    std::filesystem::remove(nudgeFile(folder));
    return;
  }
  const std::string text = formatNudges(nudges);
  (void)parseNudges(text, nudgeFile(folder).string());
  devices::writeFileAtomically(nudgeFile(folder), text);
}

}  // namespace pixelflex::calib
