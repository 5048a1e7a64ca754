#include "viewer/vnc/link.h"

namespace pixelflex::viewer {

LinkSettings settingsFor(Link link) {
  switch (link) {
    case Link::kLocal:
      break;
    case Link::kAuto:
    case Link::kLan:
      return {.quality = 9, .compression = 1};
    case Link::kWifi:
      return {.quality = 8, .compression = 2};
    case Link::kWan:
      return {.quality = 5, .compression = 4};
  }
  return {};
}

}  // namespace pixelflex::viewer
