// The corpus of model_fuzz, whole and damaged at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/model_entry.h"

namespace pixelflex::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(PIXELFLEX_SOURCE_DIR "/tests/fuzz/model_corpus")) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<Bytes> contents;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return contents;
}

TEST(ModelCorpus, IsRead) {
  const auto all = corpus();
  EXPECT_GE(all.size(), 8U);
  for (const Bytes& bytes : all) EXPECT_GE(readModel(bytes), 1U) << bytes.front();
}

TEST(ModelCorpus, MayEndAnywhere) {
  for (const Bytes& whole : corpus()) {
    for (std::size_t part = 0; part < 6; ++part) {
      EXPECT_NO_THROW((void)readModel(std::span(whole).first(whole.size() * part / 6)));
    }
  }
}

TEST(ModelCorpus, MayBeDamagedAnywhere) {
  std::mt19937 random(11);
  for (const Bytes& whole : corpus()) {
    for (int round = 0; round < 12; ++round) {
      Bytes bytes = whole;
      // The first byte is not of the file.
      for (int i = 0; i < 3; ++i) bytes[1 + random() % (bytes.size() - 1)] = static_cast<std::uint8_t>(random());
      EXPECT_NO_THROW((void)readModel(bytes)) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace pixelflex::testing
