#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/store/store.h"

namespace pixelflex::calib {

/// A document being read with its positions: accessors note a Problem and return a harmless value instead of throwing,
/// so that one pass finds everything wrong. Hides yaml-cpp. Not thread-safe. Used for wall.yaml, calibration.yaml,
/// rigs.
class YamlReader {
 public:
  /// One node of the document; cheap to copy, valid while its reader lives.
  class Node {
   public:
    [[nodiscard]] bool defined() const;
    [[nodiscard]] bool isMap() const;
    [[nodiscard]] bool isSequence() const;
    [[nodiscard]] bool isScalar() const;

    /// A required / an optional member of a map (absent: an undefined node). Marks the key as known.
    [[nodiscard]] Node required(const std::string& key) const;
    [[nodiscard]] Node optional(const std::string& key) const;
    /// Notes every key that was never asked for, with the nearest known one as a suggestion.
    void refuseUnknownKeys() const;

    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] Node at(std::size_t index) const;
    /// The keys of a map, in the file's order; all of them become known.
    [[nodiscard]] std::vector<std::string> keys() const;
    /// The elements; notes a problem unless this is a sequence of minimum to maximum elements.
    [[nodiscard]] std::vector<Node> elements(std::size_t minimum, std::size_t maximum) const;

    [[nodiscard]] std::string text() const;
    [[nodiscard]] double number(double minimum, double maximum) const;  // finite and in range
    [[nodiscard]] int integer(int minimum, int maximum) const;
    [[nodiscard]] bool boolean() const;
    /// A sequence of exactly `count` finite numbers.
    [[nodiscard]] std::vector<double> numbers(std::size_t count) const;
    [[nodiscard]] std::vector<double> numbers(std::size_t count, double minimum, double maximum) const;

    void problem(const std::string& message) const;

   private:
    friend class YamlReader;
    struct Data;
    explicit Node(std::shared_ptr<const Data> data);
    std::shared_ptr<const Data> data_;
  };

  /// Bounded: at most 64 MiB of text, limited depth and no aliases (which could expand without bound).
  YamlReader(std::string_view text, std::string file);
  ~YamlReader();
  YamlReader(const YamlReader&) = delete;
  YamlReader& operator=(const YamlReader&) = delete;

  [[nodiscard]] Node root() const;
  [[nodiscard]] const std::vector<Problem>& problems() const;
  /// Throws StoreError if anything was noted.
  void throwIfProblems() const;

  /// Checks `format:` and `version:`; returns the version. A newer one throws at once with a clear message; so do
  /// another format and text that is not YAML, because nothing else that could be said about them would help.
  int readHeader(const std::string& format, int newestVersion) const;

  /// For migration, before anything is read: the member at the dotted path `from` becomes the member at `to`, keeping
  /// its place in messages. Maps on the way to `to` are made. Nothing happens when there is no such member.
  void moveMember(const std::string& from, const std::string& to);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// The whole text of a file of the store. Throws StoreError when it is missing, unreadable or over 64 MiB.
[[nodiscard]] std::string readStoreFile(const std::string& path);

}  // namespace pixelflex::calib
