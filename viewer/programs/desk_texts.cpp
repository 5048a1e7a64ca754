#include "viewer/programs/desk_texts.h"

#include <algorithm>
#include <utility>

namespace pixelflex::viewer {
namespace {

void drop(std::vector<Clipboard>& texts, Selection selection) {
  std::erase_if(texts, [selection](const Clipboard& old) { return old.selection == selection; });
}

void putLast(std::vector<Clipboard>& texts, Clipboard text) {
  drop(texts, text.selection);
  texts.push_back(std::move(text));
}

}  // namespace

void DeskTexts::copyHere(Clipboard text) {
  const std::scoped_lock lock(mutex_);
  putLast(here_, text);
  putLast(toSend_, std::move(text));
}

std::vector<Clipboard> DeskTexts::takeForDesktop() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(toSend_, {});
}

void DeskTexts::sendAgain() {
  const std::scoped_lock lock(mutex_);
  toSend_ = here_;
}

void DeskTexts::copyThere(const Clipboard& text, bool onlyOne) {
  const std::scoped_lock lock(mutex_);
  for (const Selection selection : {Selection::kClipboard, Selection::kPrimary}) {
    if (!onlyOne && selection != text.selection) continue;
    drop(here_, selection);
    putLast(there_, {text.text, selection});
  }
}

std::vector<Clipboard> DeskTexts::takeFromDesktop() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(there_, {});
}

bool DeskTexts::isNew(const ClipboardRefused& refused) {
  const std::scoped_lock lock(mutex_);
  if (std::ranges::find(refused_, refused) != refused_.end()) return false;
  refused_.push_back(refused);
  return true;
}

}  // namespace pixelflex::viewer
