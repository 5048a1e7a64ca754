#include "viewer/renderer/upload_memory.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <functional>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytes = FrameBelt::kSlots * FrameBelt::kMaxBytes;

}  // namespace

UploadMemory::UploadMemory() : buffer_(devices::GlBuffer::create()) {
  constexpr GLbitfield kFlags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  glNamedBufferStorage(buffer_.get(), kBytes, nullptr, kFlags);
  mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(buffer_.get(), 0, kBytes, kFlags));
  if (mapped_ == nullptr) throw RendererError("the graphics driver maps no buffer for the desktop's pixels");
}

UploadMemory::~UploadMemory() {
  glUnmapNamedBuffer(buffer_.get());
}

std::optional<std::size_t> UploadMemory::offsetOf(const std::byte* place) const {
  const std::less<> before;  // the only order that holds between any two pointers
  if (before(place, mapped_) || !before(place, mapped_ + kBytes)) return std::nullopt;
  return static_cast<std::size_t>(place - mapped_);
}

void* UploadMemory::do_allocate(std::size_t bytes, std::size_t alignment) {
  const std::lock_guard lock(mutex_);
  const auto block = std::ranges::find(used_, false);
  if (bytes > FrameBelt::kMaxBytes || block == used_.end()) {
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  *block = true;
  return mapped_ + static_cast<std::size_t>(block - used_.begin()) * FrameBelt::kMaxBytes;
}

void UploadMemory::do_deallocate(void* place, std::size_t bytes, std::size_t alignment) {
  const auto offset = offsetOf(static_cast<const std::byte*>(place));
  if (!offset) return std::pmr::new_delete_resource()->deallocate(place, bytes, alignment);
  const std::lock_guard lock(mutex_);
  used_.at(*offset / FrameBelt::kMaxBytes) = false;
}

}  // namespace pixelflex::viewer
