#include "viewer/x11/x_pointer.h"

#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <algorithm>
#include <limits>

namespace pixelflex::viewer {

XPointer::XPointer(const XConnection& connection) : connection_(connection) {
  connection.requireExtension("XTEST");
}

XPointer::~XPointer() {
  setButtons(0);
  xcb_flush(connection_.get());
}

void XPointer::set(const PointerInput& pointer) {
  const auto coordinate = [](int value) {
    return static_cast<std::int16_t>(std::clamp<int>(value, 0, std::numeric_limits<std::int16_t>::max()));
  };
  xcb_test_fake_input(connection_.get(), XCB_MOTION_NOTIFY, 0, XCB_CURRENT_TIME, connection_.root(),
                      coordinate(pointer.x), coordinate(pointer.y), 0);
  setButtons(pointer.buttons);
}

void XPointer::setButtons(std::uint32_t buttons) {
  for (unsigned button = 0; button < 32; ++button) {
    const std::uint32_t bit = 1U << button;
    if (((buttons ^ buttons_) & bit) == 0) continue;
    xcb_test_fake_input(connection_.get(), (buttons & bit) != 0 ? XCB_BUTTON_PRESS : XCB_BUTTON_RELEASE,
                        static_cast<std::uint8_t>(button + 1), XCB_CURRENT_TIME, XCB_NONE, 0, 0, 0);
  }
  buttons_ = buttons;
}

}  // namespace pixelflex::viewer
