#include "viewer/programs/view_options.h"

#include <charconv>
#include <stdexcept>
#include <string_view>

namespace pixelflex::viewer {
namespace {

constexpr int kLargest = 65535;  // in the protocol

// A number and what follows it; false when it is not there.
bool takeNumber(std::string_view& text, int& number, std::string_view after) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || number < 0 || number > kLargest) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (!text.starts_with(after)) return false;
  text.remove_prefix(after.size());
  return true;
}

}  // namespace

Box parseRegion(const std::string& text) {
  std::string_view rest = text;
  int x = 0, y = 0, width = 0, height = 0;
  const bool read = takeNumber(rest, x, ",") && takeNumber(rest, y, ",") && takeNumber(rest, width, "x") &&
                    takeNumber(rest, height, "") && rest.empty();
  if (read && width > 0 && height > 0) return {x, y, x + width, y + height};
  throw std::invalid_argument("--region " + text + ": must be X,Y,WIDTHxHEIGHT in desktop pixels, like 0,0,1920x1080");
}

}  // namespace pixelflex::viewer
