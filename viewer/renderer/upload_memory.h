#pragma once

#include <array>
#include <cstddef>
#include <memory_resource>
#include <mutex>
#include <optional>

#include "devices/display/gl_handle.h"
#include "viewer/tiles/frame_belt.h"

namespace pixelflex::viewer {

/// A buffer that the GPU reads and any thread writes: pixels put there go to a texture without passing through the
/// driver's own copy. Holds one block for each slot of a belt; what does not fit comes from the heap. Made and
/// destroyed with the context current; everything else from any thread.
class UploadMemory final : public std::pmr::memory_resource {
 public:
  /// Throws RendererError when the driver does not map it.
  UploadMemory();
  ~UploadMemory() override;
  UploadMemory(const UploadMemory&) = delete;
  UploadMemory& operator=(const UploadMemory&) = delete;

  [[nodiscard]] devices::GlName buffer() const { return buffer_.get(); }
  /// Where in the buffer that is; none when it is not there.
  [[nodiscard]] std::optional<std::size_t> offsetOf(const std::byte* place) const;

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* place, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  devices::GlBuffer buffer_;
  std::byte* mapped_ = nullptr;
  std::mutex mutex_;
  std::array<bool, FrameBelt::kSlots> used_{};
};

}  // namespace pixelflex::viewer
