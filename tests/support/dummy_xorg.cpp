#include "tests/support/dummy_xorg.h"

#include <X11/Xlib.h>
#include <X11/extensions/Xrandr.h>

#include <fstream>
#include <memory>

namespace pixelflex::testing {
namespace {

/// Any timing will do where nothing is sent to a monitor.
std::string modeline(devices::Size size) {
  const auto steps = [](int shown) {
    std::string text;
    for (const int more : {0, 24, 48, 96}) text += " " + std::to_string(shown + more);
    return text;
  };
  const double megahertz = (size.width + 96) * (size.height + 96) * 60e-6;
  return "\"only\" " + std::to_string(megahertz) + steps(size.width) + steps(size.height);
}

std::string configuration(devices::Size size) {
  return R"(Section "ServerFlags"
  Option "AutoAddDevices" "false"
  Option "AutoAddGPU" "false"
EndSection
Section "Device"
  Identifier "card"
  Driver "dummy"
  VideoRam 65536
EndSection
Section "Monitor"
  Identifier "monitor"
  HorizSync 1-2000
  VertRefresh 1-2000
  Modeline )" +
         modeline(size) + R"(
EndSection
Section "Screen"
  Identifier "screen"
  Device "card"
  Monitor "monitor"
  DefaultDepth 24
  SubSection "Display"
    Depth 24
    Modes "only"
  EndSubSection
EndSection
)";
}

}  // namespace

XServer::Command dummyXorg(devices::Size size) {
  return [size](const TemporaryFolder& folder) {
    std::ofstream(folder / "xorg.conf") << configuration(size);
    return std::vector<std::string>{"Xorg",
                                    "-config",
                                    (folder / "xorg.conf").string(),
                                    "-logfile",
                                    (folder / "xorg.log").string(),
                                    "-nolisten",
                                    "tcp",
                                    "-noreset",
                                    "-novtswitch",
                                    "-sharevts"};
  };
}

std::vector<std::uint16_t> outputTables(const std::string& display) {
  const std::unique_ptr<Display, decltype(&XCloseDisplay)> x(XOpenDisplay(display.c_str()), &XCloseDisplay);
  if (!x) return {};
  const std::unique_ptr<XRRScreenResources, decltype(&XRRFreeScreenResources)> all(
      XRRGetScreenResourcesCurrent(x.get(), DefaultRootWindow(x.get())), &XRRFreeScreenResources);
  if (!all || all->ncrtc == 0) return {};
  const std::unique_ptr<XRRCrtcGamma, decltype(&XRRFreeGamma)> gamma(XRRGetCrtcGamma(x.get(), all->crtcs[0]),
                                                                     &XRRFreeGamma);
  std::vector<std::uint16_t> tables;
  if (!gamma) return tables;
  for (const auto* channel : {gamma->red, gamma->green, gamma->blue}) {
    tables.insert(tables.end(), channel, channel + gamma->size);
  }
  return tables;
}

}  // namespace pixelflex::testing
