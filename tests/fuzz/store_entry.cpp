#include "tests/fuzz/store_entry.h"

#include <stdexcept>
#include <string>

#include "calib/store/store.h"

namespace pixelflex::testing {
namespace {

template <class Parse, class Format>
void roundTrip(std::string_view text, Parse parse, Format format) {
  try {
    const auto value = parse(text, "fuzz");
    const std::string written = format(value);
    if (!(parse(written, "written") == value)) throw std::logic_error("a round trip changed the value:\n" + written);
  } catch (const calib::StoreError& error) {
    if (error.problems().empty()) throw std::logic_error("an error without a problem");
    if (error.problems().front().file == "written") throw std::logic_error(error.what());
  }
}

}  // namespace

void readAsEveryStoreFile(std::string_view text) {
  roundTrip(text, calib::parseWall, calib::formatWall);
  roundTrip(text, calib::parseCalibration, calib::formatCalibration);
}

}  // namespace pixelflex::testing
