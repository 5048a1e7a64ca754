#include "devices/projector_control/device_factory.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "devices/pan_tilt/pan_tilt_device.h"
#include "devices/projector_control/drivers.h"

namespace pixelflex::devices {
namespace {

using Make = std::unique_ptr<Device> (*)(LineLoop& loop, const LineAddress& address, const DeviceRequest& request);

struct Driver {
  std::string_view name;
  int baud;  // when the address says nothing
  Make make;
};

template <std::unique_ptr<Device> (*kMake)(LineLoop&, const LineAddress&, const std::string&)>
std::unique_ptr<Device> plain(LineLoop& loop, const LineAddress& address, const DeviceRequest& request) {
  return kMake(loop, address, request.name);
}

std::unique_ptr<Device> infocus(LineLoop& loop, const LineAddress& address, const DeviceRequest& request) {
  return makeInfocus(loop, address, request.name, request.infocusGap);
}

std::unique_ptr<Device> hitachiBeef(LineLoop& loop, const LineAddress& address, const DeviceRequest& request) {
  return makeHitachiBeef(loop, address, request.name, request.password);
}

std::unique_ptr<Device> pjlink(LineLoop& loop, const LineAddress& address, const DeviceRequest& request) {
  return makePjlink(loop, address, request.name, request.password);
}

constexpr std::array kDrivers = {Driver{"ptu", 9600, plain<makePanTiltDevice>},
                                 Driver{"hitachi-legacy", 9600, plain<makeHitachiLegacy>},
                                 Driver{"proxima-dp6850", 9600, plain<makeHitachiLegacy>},
                                 Driver{"hitachi-beef", 19200, hitachiBeef},
                                 Driver{"pjlink", 9600, pjlink},
                                 Driver{"escvp21", 9600, plain<makeEscVp21>},
                                 Driver{"infocus", 19200, infocus}};

}  // namespace

std::vector<std::string> deviceDrivers() {
  std::vector<std::string> names;
  for (const Driver& driver : kDrivers) names.emplace_back(driver.name);
  return names;
}

bool isPanTiltDriver(std::string_view driver) {
  return driver == "ptu";
}

std::unique_ptr<Device> makeDevice(LineLoop& loop, const DeviceRequest& request) {
  const auto driver = std::ranges::find(kDrivers, request.driver, &Driver::name);
  if (driver == kDrivers.end()) {
    std::string list;
    for (const auto& name : deviceDrivers()) list += (list.empty() ? "" : ", ") + name;
    throw DeviceError(request.name + ": there is no driver \"" + request.driver + "\", only " + list);
  }
  try {
    return driver->make(loop, parseLineAddress(request.at, {.baud = driver->baud}), request);
  } catch (const std::invalid_argument& error) {
    throw DeviceError(request.name + ": " + error.what());
  }
}

}  // namespace pixelflex::devices
