#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

struct xcb_connection_t;
struct xcb_selection_request_event_t;

namespace pixelflex::devices {

/// A window that nobody sees on a connection of its own, and the names of what selections are asked for. Windows and
/// atoms are X's 32-bit numbers.
class SelectionDesk {
 public:
  /// On the environment's display; follows who owns the selection of this name. Throws DisplayError.
  explicit SelectionDesk(std::string_view selection);

  [[nodiscard]] xcb_connection_t* x() const { return x_.get(); }

  std::uint32_t selection = 0, utf8 = 0, targets = 0, incremental = 0, property = 0;
  std::uint32_t window = 0;
  int ownerChanged = -1;  // event number

 private:
  struct Disconnect {
    void operator()(xcb_connection_t* x) const;
  };
  [[nodiscard]] std::uint32_t atom(std::string_view name) const;
  void watchOwner(std::uint32_t root);

  std::unique_ptr<xcb_connection_t, Disconnect> x_;
};

/// A text on its way from the program that copied it: whole, or part by part.
class IncomingSelection {
 public:
  IncomingSelection(const SelectionDesk& desk, std::size_t limit) : desk_(desk), limit_(limit) {}

  void ask();
  /// The owner's answer: the whole text, if there is one and it did not announce parts.
  std::optional<std::string> answered(std::uint32_t property);
  /// The property has a new value: the text, when this was the empty part after the last.
  std::optional<std::string> continued();
  /// What came last was text beyond the limit. Once for each.
  [[nodiscard]] bool takeTooLong() { return std::exchange(refused_, false); }

 private:
  std::pair<std::uint32_t, std::optional<std::string>> take();

  const SelectionDesk& desk_;
  std::size_t limit_;
  std::optional<std::string> parts_;
  bool tooLong_ = false;  // of the parts
  bool refused_ = false;
};

/// The text that others paste.
class OutgoingSelection {
 public:
  explicit OutgoingSelection(const SelectionDesk& desk) : desk_(desk) {}

  void offer(std::string text);
  void serve(const xcb_selection_request_event_t& request);
  /// Somebody has read a part.
  void continueFor(std::uint32_t requestor, std::uint32_t property);

 private:
  bool put(const xcb_selection_request_event_t& request);
  void begin(std::uint32_t requestor, std::uint32_t property);
  void write(std::uint32_t requestor, std::uint32_t property, std::string_view bytes);

  const SelectionDesk& desk_;
  std::string text_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> transfers_;  // what is still to be written
};

}  // namespace pixelflex::devices
