#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace pixelflex::testing {

/// A text that is in memory only in disguise, so that it is found nowhere but where somebody else has put it.
class DisguisedText {
 public:
  /// Of as many letters as are asked for, others each time.
  explicit DisguisedText(std::size_t length);
  /// The text itself, which the caller wipes.
  void copyTo(char* place) const;
  [[nodiscard]] std::size_t size() const { return disguised_.size(); }
  /// Whether it begins there.
  [[nodiscard]] bool startsAt(const char* place) const;

 private:
  std::vector<unsigned char> disguised_;
};

/// Whether the text is anywhere in this process's writable memory, regions of more than 256 MiB left out.
[[nodiscard]] bool isInMemory(const DisguisedText& text);

}  // namespace pixelflex::testing
