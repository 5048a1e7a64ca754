#pragma once

#include <cstdint>
#include <string>

#include "viewer/panel/panel_context.h"

namespace pixelflex::viewer {

/// Buttons and texts as the whole panel has them. `name` is what the map of controls calls it; every control of a
/// window has another one.

enum class ButtonLook { kPlain, kChosen, kStrong, kDanger };

/// Width 0: as wide as its text; below 0: so much less than what is left.
[[nodiscard]] bool panelButton(PanelContext& panel, const std::string& name, const std::string& text,
                               ButtonLook look = ButtonLook::kPlain, float width = 0, float height = 0);
/// What a control does, when the pointer rests on it.
void panelHint(const std::string& text);
void dimText(const std::string& text);
void colouredText(std::uint32_t colour, const std::string& text);
/// In several lines where it must be.
void wrappedText(std::uint32_t colour, const std::string& text);
/// A heading over a part of a pane.
void panelHeading(const std::string& text, const std::string& remark = "");
/// A round light in the line of text that follows, green, yellow, red or grey.
void statusDot(std::uint32_t colour);
/// Shortened to `width`, with a hint that tells all of it.
void shortText(std::uint32_t colour, const std::string& text, float width);

/// What a device is doing or what is wrong with it, and the colour that says so.
struct DeviceWords {
  std::string text;
  std::uint32_t colour;
};
[[nodiscard]] DeviceWords wordsOf(const DeviceState& state);

}  // namespace pixelflex::viewer
