#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace pixelflex::devices {

/// The clipboard of the environment's X display, the selection CLIPBOARD, as UTF-8 text. On a connection and a thread
/// of its own: programs that copy or paste slowly, or never answer, hold up nobody here.
class Clipboard {
 public:
  /// `onCopied` is called from the clipboard's thread with what another program copied, if it is text of at most
  /// `limit` bytes. What was copied before this began counts as well. Throws DisplayError.
  Clipboard(std::size_t limit, std::function<void(std::string text)> onCopied);
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
