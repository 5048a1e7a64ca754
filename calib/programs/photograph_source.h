#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "calib/capture/photographs.h"
#include "calib/store/wall.h"

namespace pixelflex::calib {

/// Where the photographs of a calibration come from, with the devices that must outlive them.
class PhotographSource {
 public:
  PhotographSource() = default;
  virtual ~PhotographSource() = default;
  PhotographSource(const PhotographSource&) = delete;
  PhotographSource& operator=(const PhotographSource&) = delete;
  [[nodiscard]] virtual Photographs& photographs() = 0;
  /// Whether what is wrong with a photograph is the wall's fault, and not that of a file.
  [[nodiscard]] virtual bool isLive() const = 0;
};

/// `photos`: folders of photographs; none: what wall.yaml says, a camera with its projectors, or the captures. `keep`:
/// whether photographs taken now are kept in the wall's captures. Throws std::runtime_error.
[[nodiscard]] std::unique_ptr<PhotographSource> openSource(const std::filesystem::path& folder, const Wall& wall,
                                                           const std::vector<std::string>& photos, bool keep);

}  // namespace pixelflex::calib
