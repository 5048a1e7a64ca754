#include "viewer/vnc/secret.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace pixelflex::viewer {

Secret::Secret(std::string_view text) : bytes_(std::make_unique<char[]>(text.size())), size_(text.size()) {
  std::ranges::copy(text, bytes_.get());
}

Secret::~Secret() {
  if (bytes_ != nullptr) ::explicit_bzero(bytes_.get(), size_);
}

void Secret::swap(Secret& other) noexcept {
  std::swap(bytes_, other.bytes_);
  std::swap(size_, other.size_);
}

void wipe(std::span<std::byte> bytes) {
  ::explicit_bzero(bytes.data(), bytes.size());
}

}  // namespace pixelflex::viewer
