#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace pixelflex::devices {

enum class Selection {
  kClipboard,  // what is copied and pasted
  kPrimary,    // what is marked with the mouse and pasted with its middle button
};

/// What other programs do, called from the clipboard's thread.
struct ClipboardHandlers {
  std::function<void(std::string text)> copied;
  std::function<void()> tooLong;  // a text beyond the limit was copied
};

/// One of the two clipboards of the environment's X display, as UTF-8 text. On a connection and a thread of its own:
/// programs that copy or paste slowly, or never answer, hold up nobody here.
class Clipboard {
 public:
  /// Takes texts of at most `limit` bytes. What was copied before this began counts as well. Throws DisplayError.
  Clipboard(Selection selection, std::size_t limit, ClipboardHandlers handlers);
  ~Clipboard();
  Clipboard(const Clipboard&) = delete;
  Clipboard& operator=(const Clipboard&) = delete;

  /// From here on other programs paste this. From any thread.
  void set(std::string text);

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace pixelflex::devices
