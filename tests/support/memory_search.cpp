#include "tests/support/memory_search.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <random>
#include <stdexcept>

namespace pixelflex::testing {
namespace {

constexpr unsigned char kMask = 0xa5;
constexpr std::size_t kLargest = std::size_t{256} << 20;

bool isIn(const char* bytes, std::size_t size, const DisguisedText& text) {
  for (std::size_t i = 0; i + text.size() <= size; ++i) {
    if (text.startsAt(bytes + i)) return true;
  }
  return false;
}

}  // namespace

DisguisedText::DisguisedText(std::size_t length) : disguised_(length) {
  std::random_device random;
  for (auto& letter : disguised_) letter = static_cast<unsigned char>(('a' + random() % 26) ^ kMask);
}

void DisguisedText::copyTo(char* place) const {
  for (const unsigned char letter : disguised_) *place++ = static_cast<char>(letter ^ kMask);
}

bool DisguisedText::startsAt(const char* place) const {
  return std::ranges::all_of(disguised_, [&place](unsigned char letter) {
    return static_cast<unsigned char>(static_cast<unsigned char>(*place++) ^ kMask) == letter;
  });
}

bool isInMemory(const DisguisedText& text) {
  const int memory = ::open("/proc/self/mem", O_RDONLY | O_CLOEXEC);
  if (memory < 0) throw std::runtime_error("cannot read this process's memory");
  std::ifstream maps("/proc/self/maps");
  bool found = false;
  for (std::string line; std::getline(maps, line);) {
    unsigned long begin = 0, end = 0;
    char readable = 0, writable = 0;
    if (std::sscanf(line.c_str(), "%lx-%lx %c%c", &begin, &end, &readable, &writable) != 4) continue;
    if (readable != 'r' || writable != 'w' || end - begin > kLargest) continue;
    const auto copy = std::make_unique<char[]>(end - begin);
    const ssize_t got = ::pread(memory, copy.get(), end - begin, static_cast<off_t>(begin));
    if (got > 0) found = found || isIn(copy.get(), static_cast<std::size_t>(got), text);
    std::memset(copy.get(), 0, end - begin);  // or what it found would be found again
  }
  ::close(memory);
  return found;
}

}  // namespace pixelflex::testing
