#include "viewer/vnc/rfb_resize.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/rfb_messages.h"

namespace pixelflex::viewer {
namespace {

// Of ExtendedDesktopSize: reasons and results.
constexpr int kAskedByUs = 1;
constexpr int kDone = 0;
constexpr int kProhibited = 1;
constexpr int kOutOfResources = 2;

constexpr std::size_t kMaxScreens = 255;

void refuseLayout(RfbState& rfb, const std::string& why) {
  rfb.wantedLayout.reset();
  appendEvent(rfb.events, ResizeRefused{rfb.where + " " + why});
}

std::string reasonOf(int status) {
  if (status == kProhibited) return "does not let viewers change its desktop's size";
  if (status == kOutOfResources) return "has not the memory for a desktop of the wall's size";
  return "does not accept the size and screens that the wall asks for";
}

RfbScreen readScreen(RfbState& rfb) {
  std::array<std::uint8_t, 16> bytes{};
  rfb.read(bytes);
  const auto number = [&bytes](std::size_t at, std::size_t count) {
    return bigEndian(std::span(bytes).subspan(at, count));
  };
  const int x = static_cast<int>(number(4, 2));
  const int y = static_cast<int>(number(6, 2));
  return {number(0, 4), {x, y, x + static_cast<int>(number(8, 2)), y + static_cast<int>(number(10, 2))}};
}

// Screens that are there keep their identity, so that windows stay on them.
std::vector<RfbScreen> numbered(const std::vector<Box>& boxes, const std::vector<RfbScreen>& present) {
  std::uint32_t fresh = 0;
  std::vector<RfbScreen> screens;
  const auto taken = [&present](std::uint32_t id) {
    return std::ranges::find(present, id, &RfbScreen::id) != present.end();
  };
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i < present.size()) {
      screens.push_back({present[i].id, boxes[i]});
      continue;
    }
    while (taken(fresh)) ++fresh;
    screens.push_back({fresh++, boxes[i]});
  }
  return screens;
}

std::vector<std::uint8_t> setDesktopSizeMessage(devices::Size size, const std::vector<RfbScreen>& screens) {
  std::vector<std::uint8_t> message{251, 0};
  const auto append = [&message](int value, int bytes) {
    appendNumber(message, static_cast<std::uint32_t>(value), bytes);
  };
  append(size.width, 2);
  append(size.height, 2);
  append(static_cast<int>(screens.size()), 1);
  append(0, 1);
  for (const auto& [id, box] : screens) {
    appendNumber(message, id, 4);
    for (const int value : {box.left, box.top, box.width(), box.height()}) append(value, 2);
    append(0, 4);  // flags
  }
  return message;
}

}  // namespace

void requestWantedLayout(RfbState& rfb) {
  if (!rfb.wantedLayout) return;
  // A server that has screens tells of them with its first update.
  if (!rfb.screens && rfb.everUpdated) return refuseLayout(rfb, "cannot change its desktop's size");
  if (!rfb.screens) return;
  const ScreenLayout& wanted = *rfb.wantedLayout;
  if (wanted.screens.empty() || wanted.screens.size() > kMaxScreens) {
    return refuseLayout(rfb, "is asked for more screens than there can be");
  }
  const std::vector<RfbScreen> screens = numbered(wanted.screens, *rfb.screens);
  if (rfb.pixelsSize == wanted.desktop && screens == *rfb.screens) {
    rfb.wantedLayout.reset();
    return;
  }
  rfb.write(setDesktopSizeMessage(wanted.desktop, screens));
  rfb.wantedLayout.reset();
}

bool readExtendedDesktopSize(RfbState& rfb, int reason, int status, devices::Size size) {
  std::array<std::uint8_t, 4> head{};  // how many, padding
  rfb.read(head);
  std::vector<RfbScreen> screens;
  for (int i = 0; i < head.front(); ++i) screens.push_back(readScreen(rfb));
  if (reason == kAskedByUs && status != kDone) {
    refuseLayout(rfb, reasonOf(status));
    return false;
  }
  rfb.screens = std::move(screens);
  return size != rfb.pixelsSize;
}

}  // namespace pixelflex::viewer
