#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "devices/display/gl_context.h"

namespace pixelflex::viewer {

/// How the desktop's pixels reach its texture. Neither choice changes what is shown: where the order is not the
/// pixels' own, the texture's swizzle puts red and blue back, so that no server need be asked for another one.
struct UploadPath {
  enum class Order { kRgba, kBgra };       // what GL is told that the four bytes are
  enum class Memory { kClient, kMapped };  // read by the driver during the call, or by the GPU from a mapped buffer
  Order order = Order::kRgba;
  Memory memory = Memory::kClient;
  bool operator==(const UploadPath&) const = default;
};

struct UploadRate {
  UploadPath path;
  double bytesPerSecond = 0;
};

/// Every path's rate on this driver, measured with a tile: some ten milliseconds. Needs nothing, leaves
/// nothing.
[[nodiscard]] std::vector<UploadRate> measureUploads(devices::GlContext& context);

/// The fastest, but the plain one (client memory, red first) unless another is faster by a tenth.
[[nodiscard]] UploadPath fastestUpload(std::span<const UploadRate> rates);

/// "client memory, RGBA 5.2 GB/s (client memory, BGRA 0.6; …)": the one that is taken first.
[[nodiscard]] std::string describeUploads(std::span<const UploadRate> rates);

}  // namespace pixelflex::viewer
