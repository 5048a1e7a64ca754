#pragma once

struct _XDisplay;

namespace pixelflex::devices {

/// The small Latin letter on a key of the keyboard, for shortcuts: what the key has without modifiers, in the group
/// that is chosen, or else in any other; where no group has a Latin letter, that of a US keyboard at the same place. 0:
/// neither, or the key has a Latin character that is no letter.
[[nodiscard]] char letterOnKey(_XDisplay* display, unsigned keycode, unsigned group);

}  // namespace pixelflex::devices
