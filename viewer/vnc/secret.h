#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

namespace pixelflex::viewer {

/// A text of which no copy stays in memory: it is on the heap, nowhere else, and overwritten when it goes.
class Secret {
 public:
  Secret() = default;
  /// Not explicit, so that a literal may be given; what `text` views is still its owner's to wipe().
  Secret(std::string_view text);                                // NOLINT(google-explicit-constructor)
  Secret(const char* text) : Secret(std::string_view(text)) {}  // NOLINT(google-explicit-constructor)
  Secret(const Secret& other) : Secret(other.text()) {}
  Secret(Secret&& other) noexcept { swap(other); }
  Secret& operator=(Secret other) noexcept {
    swap(other);
    return *this;
  }
  ~Secret();

  [[nodiscard]] std::string_view text() const { return {bytes_.get(), size_}; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  void swap(Secret& other) noexcept;

  std::unique_ptr<char[]> bytes_;
  std::size_t size_ = 0;
};

/// Overwrites what held a secret for a moment.
void wipe(std::span<std::byte> bytes);
template <class Range>
void wipe(Range& range) {
  wipe(std::as_writable_bytes(std::span(range)));
}

}  // namespace pixelflex::viewer
