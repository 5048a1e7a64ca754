#pragma once

#include <mutex>
#include <vector>

#include "viewer/vnc/session_event.h"

namespace pixelflex::viewer {

/// Texts that were copied on this side or on the desktop, on their way to the other. Thread-safe.
class DeskTexts {
 public:
  void copyHere(Clipboard text);
  /// Texts for the desktop: what was copied here since the last call, the oldest first.
  [[nodiscard]] std::vector<Clipboard> takeForDesktop();
  /// A desktop has come (back): it is to have what was copied here last, unless something was copied there since.
  void sendAgain();

  /// With `onlyOne` clipboard on the desktop, its text is for both here.
  void copyThere(const Clipboard& text, bool onlyOne);
  [[nodiscard]] std::vector<Clipboard> takeFromDesktop();

  /// False when the same was refused before.
  [[nodiscard]] bool isNew(const ClipboardRefused& refused);

 private:
  std::mutex mutex_;             // guards what follows
  std::vector<Clipboard> here_;  // the last of each kind, the oldest first
  std::vector<Clipboard> toSend_;
  std::vector<Clipboard> there_;
  std::vector<ClipboardRefused> refused_;
};

}  // namespace pixelflex::viewer
