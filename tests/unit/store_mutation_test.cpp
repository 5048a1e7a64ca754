#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/store_entry.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

/// The corpus of the fuzzer, which holds what once went wrong, and the saved files of all versions.
std::vector<std::string> seeds() {
  std::vector<std::string> texts;
  for (const auto* folder : {"/tests/fuzz/corpus", "/tests/data"}) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(PIXELFLEX_SOURCE_DIR) + folder)) {
      if (entry.path().extension() == ".yaml") paths.push_back(entry.path());
    }
    std::ranges::sort(paths);
    for (const auto& path : paths) {
      std::ifstream file(path, std::ios::binary);
      texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  }
  return texts;
}

class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  std::string mutated(std::string text, const std::vector<std::string>& others) {
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) edit(text, others[below(others.size())]);
    return text;
  }

  std::size_t below(std::size_t bound) { return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random_); }

 private:
  void edit(std::string& text, const std::string& other) {
    static const std::vector<std::string> kPieces = {
        "[",    "]",    "{",    "}",   ": ",   ",",     "- ",          "\n", "  ",
        "\t",   "?",    "&a ",  "*a",  "!!x ", "|",     ">",           "\"", "'",
        "#",    "%",    "---",  "...", "-1",   "1e308", "nan",         "~",  std::string(1, 0),
        "\xff", "\x80", "<<: ", "@",   "1e-9", "0x1",   "99999999999", "\r"};
    const std::size_t place = below(text.size() + 1);
    const std::size_t length = std::min(below(12) + 1, text.size() - place);
    switch (below(6)) {
      case 0:
        text.erase(place, length);
        break;
      case 1:
        text.insert(place, kPieces[below(kPieces.size())]);
        break;
      case 2:
        text.replace(place, length, kPieces[below(kPieces.size())]);
        break;
      case 3:
        text.insert(place, text.substr(below(text.size() + 1), below(80)));
        break;
      case 4:
        text.insert(place, other.substr(below(other.size() + 1), below(80)));
        break;
      default:
        if (place < text.size()) text[place] = static_cast<char>(below(256));
    }
  }

  std::mt19937 random_;
};

TEST(StoreMutation, TheCorpusIsReadWithoutHarm) {
  const auto texts = seeds();
  ASSERT_GE(texts.size(), 10U);
  for (const auto& text : texts) EXPECT_NO_THROW(readAsEveryStoreFile(text)) << text;
}

TEST(StoreMutation, RandomEditsAreReadWithoutHarm) {
  const std::uint32_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::cout << "seed " << seed << '\n';
  RecordProperty("seed", std::to_string(seed));
  const auto texts = seeds();
  Mutator mutator(seed);
  for (int i = 0; i < 6000; ++i) {
    const std::string text = mutator.mutated(texts[mutator.below(texts.size())], texts);
    ASSERT_NO_THROW(readAsEveryStoreFile(text)) << text;
  }
}

}  // namespace
}  // namespace pixelflex::testing
