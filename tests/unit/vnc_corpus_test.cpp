// The corpus of vnc_fuzz, recorded from Xvnc and x11vnc, whole and damaged at random.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/vnc_entry.h"

namespace pixelflex::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> corpus() {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder(PIXELFLEX_SOURCE_DIR "/tests/fuzz/vnc_corpus");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<Bytes> contents;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return contents;
}

TEST(VncCorpus, IsHeardToItsEnd) {
  const std::vector<Bytes> all = corpus();
  EXPECT_GE(all.size(), 6u);
  for (const Bytes& bytes : all) EXPECT_GE(hearServer(bytes), 1);
}

// Bytes changed, left out, said twice.
Bytes damaged(Bytes bytes, std::mt19937& random) {
  const auto pick = [&random](std::size_t below) {
    return static_cast<std::ptrdiff_t>(random() % std::max<std::size_t>(below, 1));
  };
  for (std::uint32_t left = 1 + random() % 4; left > 0; --left) {
    const auto at = bytes.begin() + std::min<std::ptrdiff_t>(pick(bytes.size()), std::ssize(bytes) - 1);
    const auto end = at + std::min<std::ptrdiff_t>(pick(40), bytes.end() - at);
    if (random() % 3 == 0) {
      bytes.erase(at, end);
    } else if (random() % 2 == 0) {
      const Bytes again(at, end);
      bytes.insert(at, again.begin(), again.end());
    } else {
      *at = static_cast<std::uint8_t>(random() % 4 == 0 ? 255 : random());
    }
    if (bytes.empty()) break;
  }
  return bytes;
}

TEST(VncCorpus, MayBeDamagedAnywhere) {
  std::mt19937 random(7);
  for (const Bytes& bytes : corpus()) {
    for (int i = 0; i < 60; ++i) EXPECT_NO_THROW((void)hearServer(damaged(bytes, random))) << "attempt " << i;
  }
}

}  // namespace
}  // namespace pixelflex::testing
