#include "devices/pan_tilt/pan_tilt_reply.h"

#include <charconv>

namespace pixelflex::devices {
namespace {

bool isStop(std::string_view bytes, std::size_t at) {
  return bytes[at] == '!' && at + 1 < bytes.size() && (bytes[at + 1] == 'P' || bytes[at + 1] == 'T');
}

/// Where the reply's mark is: its "*", or the "!" of an error. Echoed characters come before.
std::size_t markOf(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '*') return i;
    if (bytes[i] != '!') continue;
    if (isStop(bytes, i)) {
      ++i;
    } else if (i + 1 < bytes.size()) {
      return i;
    }
  }
  return std::string_view::npos;
}

}  // namespace

std::optional<std::size_t> endOfPanTiltReply(std::string_view received) {
  const std::size_t mark = markOf(received);
  if (mark == std::string_view::npos) return std::nullopt;
  const std::size_t end = received.find_first_of("\r\n", mark);
  if (end == std::string_view::npos) return std::nullopt;
  return end + 1;
}

PanTiltReply parsePanTiltReply(std::string_view bytes) {
  PanTiltReply reply;
  const std::size_t mark = markOf(bytes);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (isStop(bytes, i)) {
      ++(bytes[i + 1] == 'P' ? reply.panStops : reply.tiltStops);
      ++i;
    } else if (i == mark) {
      reply.success = bytes[i] == '*';
    } else if (i > mark && bytes[i] >= ' ') {
      reply.text += bytes[i];
    }
  }
  if (reply.text.starts_with(' ')) reply.text.erase(0, 1);
  return reply;
}

std::optional<double> numberInReply(std::string_view text) {
  while (!text.empty()) {
    const auto cut = text.find(' ');
    const std::string_view word = text.substr(0, cut);
    text = cut == std::string_view::npos ? std::string_view() : text.substr(cut + 1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (!word.empty() && error == std::errc() && end == word.data() + word.size()) return number;
  }
  return std::nullopt;
}

}  // namespace pixelflex::devices
