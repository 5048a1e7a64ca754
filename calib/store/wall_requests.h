#pragma once

#include "calib/store/wall.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {

/// Sections of wall.yaml that say how the wall shall look. Each notes what is wrong with its node.
[[nodiscard]] Blend readBlend(const YamlReader::Node& node);
[[nodiscard]] DisplayRequest readDisplay(const YamlReader::Node& node);
[[nodiscard]] DesktopRequest readDesktop(const YamlReader::Node& node);
/// The node may be undefined.
[[nodiscard]] Transfer readTransfer(const YamlReader::Node& node);

}  // namespace pixelflex::calib
