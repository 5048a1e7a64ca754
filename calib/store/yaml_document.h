#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/store.h"

namespace pixelflex::calib {

/// Bounds on what a file of the store may ask of us.
inline constexpr std::size_t kMaxStoreBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxYamlNodes = 2'000'000;
inline constexpr std::size_t kMaxYamlDepth = 32;
inline constexpr std::size_t kMaxProblems = 200;

/// A node of a YAML document with its position. Children are indices into YamlDocument::nodes.
struct YamlNode {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  int line = 0;
  int column = 0;
  int keyLine = 0;  // of the key, when this is the value of a map
  int keyColumn = 0;
  std::string key;                    // when this is the value of a map
  std::string text;                   // of a scalar
  std::vector<std::size_t> children;  // of a sequence or map, in the file's order
};

/// A parsed document: the root is nodes[0]. Empty after a syntax problem.
struct YamlDocument {
  std::vector<YamlNode> nodes;
  std::vector<Problem> problems;

  [[nodiscard]] bool hasRoot() const { return !nodes.empty(); }
  /// The value of `key` in a map; nodes.size() when there is none.
  [[nodiscard]] std::size_t find(std::size_t map, std::string_view key) const;
  /// See YamlReader::moveMember.
  void moveMember(std::string_view from, std::string_view to);
  /// Notes a problem; those past kMaxProblems are dropped and the last one says so.
  void note(Problem problem);
};

/// Never throws for what the text holds: whatever is wrong becomes a problem. Aliases, anchors, tags, repeated keys,
/// keys that are not plain text, several documents, tabs in the indentation, bytes that are not UTF-8 and texts beyond
/// the bounds above are all refused.
[[nodiscard]] YamlDocument parseYaml(std::string_view text, const std::string& file);

/// `text` in quotes for a message: shortened, without control characters.
[[nodiscard]] std::string quotedForMessage(std::string_view text);

}  // namespace pixelflex::calib
