#include "viewer/x11/x_keyboard.h"

#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <algorithm>
#include <array>

namespace pixelflex::viewer {
namespace {

// Keysyms, as in X11/keysymdef.h.
constexpr std::uint32_t kShiftLeft = 0xffe1;
constexpr std::uint32_t kShiftRight = 0xffe2;
constexpr std::uint32_t kThirdLevel = 0xfe03;
constexpr std::uint32_t kNumLock = 0xff7f;
constexpr std::uint32_t kFirstFunction = 0xfd00;
constexpr std::uint32_t kLastFunction = 0xffff;
constexpr std::uint32_t kFirstKeypad = 0xffaa;  // what a number lock changes: *+,-./0…9 and =
constexpr std::uint32_t kLastKeypad = 0xffbd;
constexpr std::uint32_t kUnicode = 0x01000000;

// The core protocol's columns of a layout's first group: plain, Shift, Alt Gr, both.
constexpr std::array<std::size_t, 4> kColumns{0, 1, 4, 5};

bool isKeypad(std::uint32_t keysym) {
  return keysym >= kFirstKeypad && keysym <= kLastKeypad;
}

// Those for which Shift means something else than another symbol: arrows, Tab, modifiers…
bool ignoresModifiers(std::uint32_t keysym) {
  return keysym >= kFirstFunction && keysym <= kLastFunction && !isKeypad(keysym);
}

// Latin-1 has had its keysyms before there was Unicode.
std::uint32_t usualForm(std::uint32_t keysym) {
  return keysym >= kUnicode && keysym < kUnicode + 0x100 ? keysym - kUnicode : keysym;
}

bool isLetterPair(std::uint32_t lower, std::uint32_t upper) {
  const bool latin = (lower >= 'a' && lower <= 'z') || (lower >= 0xe0 && lower <= 0xfe && lower != 0xf7);
  return latin && upper + 0x20 == lower;
}

}  // namespace

XKeyboard::XKeyboard(const XConnection& connection) : connection_(connection) {
  connection.requireExtension("XTEST");
  load();
}

XKeyboard::~XKeyboard() {
  for (const auto& [keysym, code] : down_) fake(code, false);
  for (const std::uint8_t code : borrowed_) remap(code, XCB_NO_SYMBOL);
  xcb_flush(connection_.get());
}

void XKeyboard::handle(const XEvent& event) {
  if (event.type() != XCB_MAPPING_NOTIFY) return;
  if (event.as<xcb_mapping_notify_event_t>().request != XCB_MAPPING_POINTER) stale_ = true;
}

void XKeyboard::load() {
  stale_ = false;
  const xcb_setup_t& setup = *xcb_get_setup(connection_.get());
  firstCode_ = setup.min_keycode;
  const auto count = static_cast<std::uint8_t>(setup.max_keycode - setup.min_keycode + 1);
  const auto mapping = connection_.reply<xcb_get_keyboard_mapping_reply_t>(
      xcb_get_keyboard_mapping(connection_.get(), setup.min_keycode, count));
  symbols_.clear();
  if (mapping == nullptr) return;
  symbolsPerCode_ = mapping->keysyms_per_keycode;
  const xcb_keysym_t* first = xcb_get_keyboard_mapping_keysyms(mapping.get());
  symbols_.assign(first, first + xcb_get_keyboard_mapping_keysyms_length(mapping.get()));
  loadModifiers();
}

void XKeyboard::loadModifiers() {
  shiftCodes_.clear();
  thirdCodes_.clear();
  thirdMask_ = numbersMask_ = 0;
  const auto mapping = connection_.reply<xcb_get_modifier_mapping_reply_t>(xcb_get_modifier_mapping(connection_.get()));
  if (mapping == nullptr) return;
  const xcb_keycode_t* code = xcb_get_modifier_mapping_keycodes(mapping.get());
  for (unsigned modifier = 0; modifier < 8; ++modifier) {
    for (unsigned i = 0; i < mapping->keycodes_per_modifier; ++i, ++code) {
      const auto symbols = symbolsOf(*code);
      const auto has = [&symbols](std::uint32_t keysym) { return std::ranges::find(symbols, keysym) != symbols.end(); };
      const auto mask = static_cast<std::uint16_t>(1U << modifier);
      if (has(kShiftLeft) || has(kShiftRight)) shiftCodes_.push_back(*code);
      if (has(kNumLock)) numbersMask_ = mask;
      if (!has(kThirdLevel)) continue;
      thirdMask_ = mask;
      thirdCodes_.push_back(*code);
    }
  }
}

std::span<const std::uint32_t> XKeyboard::symbolsOf(int code) const {
  const auto perCode = static_cast<std::size_t>(symbolsPerCode_);
  const std::size_t begin = static_cast<std::size_t>(std::max(code - firstCode_, 0)) * perCode;
  if (code < firstCode_ || begin + perCode > symbols_.size()) return {};
  return std::span(symbols_).subspan(begin, perCode);
}

XKeyboard::Modifiers XKeyboard::modifiers() const {
  const auto pointer =
      connection_.reply<xcb_query_pointer_reply_t>(xcb_query_pointer(connection_.get(), connection_.root()));
  if (pointer == nullptr) return {};
  const auto has = [&](unsigned mask) { return (pointer->mask & mask) != 0; };
  return {has(XCB_MOD_MASK_SHIFT), has(thirdMask_), has(XCB_MOD_MASK_LOCK), has(numbersMask_)};
}

std::vector<XKeyboard::Stroke> XKeyboard::strokesFor(std::uint32_t keysym, const Modifiers& now) const {
  std::vector<Stroke> strokes;
  const int codes = symbolsPerCode_ == 0 ? 0 : static_cast<int>(symbols_.size()) / symbolsPerCode_;
  for (int code = firstCode_; code < firstCode_ + codes; ++code) {
    const auto symbols = symbolsOf(code);
    const std::uint32_t shifted = symbols.size() > 1 ? symbols[1] : XCB_NO_SYMBOL;
    for (std::size_t level = 0; level < kColumns.size(); ++level) {
      const std::size_t column = kColumns[level];
      if (column >= symbols.size() || symbols[column] != keysym) continue;
      Stroke stroke{static_cast<std::uint8_t>(code), level % 2 == 1, level >= 2, ignoresModifiers(keysym)};
      const bool letter = isLetterPair(symbols[0], shifted);
      const bool pad = isKeypad(shifted);
      const bool locked = level < 2 && ((letter && now.caps) || (pad && now.numbers));
      if (locked) stroke.shift = !stroke.shift;
      // A key with a single symbol shows it whatever is held.
      if (level == 0 && (shifted == XCB_NO_SYMBOL || shifted == keysym) && !letter) stroke.free = true;
      strokes.push_back(stroke);
    }
  }
  return strokes;
}

XKeyboard::Stroke XKeyboard::strokeFor(std::uint32_t keysym, const Modifiers& now) {
  const auto changes = [&now, this](const Stroke& stroke) {
    if (stroke.third && thirdCodes_.empty()) return 100;
    return stroke.free ? 0 : (stroke.shift != now.shift ? 1 : 0) + (stroke.third != now.third ? 2 : 0);
  };
  const std::vector<Stroke> strokes = strokesFor(keysym, now);
  const auto best = std::ranges::min_element(strokes, {}, changes);
  if (best != strokes.end() && changes(*best) < 100) return *best;
  return {borrow(keysym), false, false, true};
}

std::uint8_t XKeyboard::borrow(std::uint32_t keysym) {
  std::uint8_t chosen = 0;
  const int last = xcb_get_setup(connection_.get())->max_keycode;
  for (int code = last; code >= firstCode_ && chosen == 0; --code) {
    const auto symbols = symbolsOf(code);
    const bool unused = std::ranges::all_of(symbols, [](std::uint32_t symbol) { return symbol == XCB_NO_SYMBOL; });
    if (!symbols.empty() && unused) chosen = static_cast<std::uint8_t>(code);
  }
  if (chosen == 0) {
    const auto isFree = [this](std::uint8_t code) {
      return std::ranges::none_of(down_, [code](const auto& held) { return held.second == code; });
    };
    const auto oldest = std::ranges::find_if(borrowed_, isFree);
    if (oldest == borrowed_.end()) return 0;
    chosen = *oldest;
    borrowed_.erase(oldest);
  }
  borrowed_.push_back(chosen);
  remap(chosen, keysym);
  load();
  return chosen;
}

void XKeyboard::remap(std::uint8_t code, std::uint32_t keysym) {
  const std::array<xcb_keysym_t, 2> both{keysym, keysym};
  xcb_change_keyboard_mapping(connection_.get(), 1, code, 2, both.data());
}

void XKeyboard::press(std::uint32_t keysym) {
  keysym = usualForm(keysym);
  if (down_.contains(keysym)) return;
  if (stale_) load();
  const Modifiers now = modifiers();
  const Stroke stroke = strokeFor(keysym, now);
  if (stroke.code == 0) return;
  down_[keysym] = stroke.code;
  pressWith(stroke, now);
}

void XKeyboard::pressWith(const Stroke& stroke, const Modifiers& now) {
  std::vector<std::uint8_t> pressed;
  std::vector<std::uint8_t> released;
  const auto want = [&](bool wanted, bool is, const std::vector<std::uint8_t>& codes) {
    if (stroke.free || wanted == is || codes.empty()) return;
    if (wanted) {
      pressed.push_back(codes.front());
    } else {
      std::ranges::copy(codesDown(codes), std::back_inserter(released));
    }
  };
  want(stroke.shift, now.shift, shiftCodes_);
  want(stroke.third, now.third, thirdCodes_);
  for (const std::uint8_t code : pressed) fake(code, true);
  for (const std::uint8_t code : released) fake(code, false);
  fake(stroke.code, true);
  for (const std::uint8_t code : pressed) fake(code, false);
  for (const std::uint8_t code : released) fake(code, true);
}

void XKeyboard::release(std::uint32_t keysym) {
  const auto held = down_.find(usualForm(keysym));
  if (held == down_.end()) return;
  fake(held->second, false);
  down_.erase(held);
}

std::vector<std::uint8_t> XKeyboard::codesDown(std::span<const std::uint8_t> codes) const {
  const auto keymap = connection_.reply<xcb_query_keymap_reply_t>(xcb_query_keymap(connection_.get()));
  std::vector<std::uint8_t> down;
  for (const std::uint8_t code : codes) {
    if (keymap != nullptr && (keymap->keys[code / 8] & 1 << code % 8) != 0) down.push_back(code);
  }
  return down;
}

void XKeyboard::fake(std::uint8_t code, bool down) const {
  xcb_test_fake_input(connection_.get(), down ? XCB_KEY_PRESS : XCB_KEY_RELEASE, code, XCB_CURRENT_TIME, XCB_NONE, 0, 0,
                      0);
}

}  // namespace pixelflex::viewer
