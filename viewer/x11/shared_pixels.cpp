#include "viewer/x11/shared_pixels.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace pixelflex::viewer {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

SharedPixels::SharedPixels(std::size_t size) : memory_(::memfd_create("pixelflex-desktop", MFD_CLOEXEC)), size_(size) {
  if (memory_.get() < 0) fail("memfd_create");
  if (::ftruncate(memory_.get(), static_cast<off_t>(size)) != 0) fail("ftruncate");
  void* mapped = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, memory_.get(), 0);
  if (mapped == MAP_FAILED) fail("mmap");
  data_ = static_cast<std::byte*>(mapped);
}

SharedPixels::SharedPixels(SharedPixels&& other) noexcept
    : memory_(std::move(other.memory_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

SharedPixels& SharedPixels::operator=(SharedPixels&& other) noexcept {
  std::swap(memory_, other.memory_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

SharedPixels::~SharedPixels() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

int SharedPixels::duplicateDescriptor() const {
  const int duplicate = ::fcntl(memory_.get(), F_DUPFD_CLOEXEC, 0);
  if (duplicate < 0) fail("dup");
  return duplicate;
}

}  // namespace pixelflex::viewer
