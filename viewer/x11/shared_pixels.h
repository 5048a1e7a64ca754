#pragma once

#include <cstddef>
#include <span>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// Memory that another process can be given by its descriptor; it goes with its last user, however that ends. Movable.
/// Pages that were never written to cost nothing.
class SharedPixels {
 public:
  SharedPixels() = default;
  /// Throws std::system_error when there is not enough.
  explicit SharedPixels(std::size_t size);
  SharedPixels(SharedPixels&& other) noexcept;
  SharedPixels& operator=(SharedPixels&& other) noexcept;
  SharedPixels(const SharedPixels&) = delete;
  SharedPixels& operator=(const SharedPixels&) = delete;
  ~SharedPixels();

  /// A new descriptor, the caller's.
  [[nodiscard]] int duplicateDescriptor() const;
  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  FileDescriptor memory_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace pixelflex::viewer
