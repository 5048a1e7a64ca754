#include "devices/display/key_letters.h"

#include <X11/XKBlib.h>
#include <X11/Xlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

namespace pixelflex::devices {
namespace {

struct FreeKeyboard {
  void operator()(XkbDescPtr keyboard) const { XkbFreeKeyboard(keyboard, 0, True); }
};

bool isLatin(KeySym keysym) {
  return keysym > ' ' && keysym <= '~';
}

char smallLetter(KeySym keysym) {
  if (keysym >= 'A' && keysym <= 'Z') return static_cast<char>(keysym - 'A' + 'a');
  return keysym >= 'a' && keysym <= 'z' ? static_cast<char>(keysym) : '\0';
}

/// XKB names the keys by row and column: AD01 is the first of the upper row of letters.
char letterAt(std::string_view name) {
  struct Row {
    std::string_view name;
    std::string_view letters;
  };
  constexpr std::array kRows{Row{"AD", "qwertyuiop"}, Row{"AC", "asdfghjkl"}, Row{"AB", "zxcvbnm"}};
  const auto row = std::ranges::find(kRows, name.substr(0, 2), &Row::name);
  if (name.size() != 4 || row == kRows.end()) return 0;
  const int column = (name[2] - '0') * 10 + (name[3] - '0');
  const bool there = column >= 1 && column <= static_cast<int>(row->letters.size());
  return there ? row->letters[static_cast<std::size_t>(column - 1)] : '\0';
}

char letterByPlace(Display* display, unsigned keycode) {
  const std::unique_ptr<XkbDescRec, FreeKeyboard> keyboard(XkbGetMap(display, 0, XkbUseCoreKbd));
  if (keyboard == nullptr || XkbGetNames(display, XkbKeyNamesMask, keyboard.get()) != Success) return 0;
  if (keycode < keyboard->min_key_code || keycode > keyboard->max_key_code) return 0;
  const std::string_view name(keyboard->names->keys[keycode].name, XkbKeyNameLength);
  return letterAt(name.substr(0, name.find('\0')));
}

}  // namespace

char letterOnKey(Display* display, unsigned keycode, unsigned group) {
  const auto plain = [&](unsigned of) {
    return XkbKeycodeToKeysym(display, static_cast<KeyCode>(keycode), static_cast<int>(of), 0);
  };
  if (isLatin(plain(group))) return smallLetter(plain(group));
  for (unsigned other = 0; other < XkbNumKbdGroups; ++other) {
    if (const char letter = smallLetter(plain(other))) return letter;
  }
  return letterByPlace(display, keycode);
}

}  // namespace pixelflex::devices
