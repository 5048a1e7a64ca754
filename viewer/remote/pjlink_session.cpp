#include "viewer/remote/pjlink_session.h"

#include <algorithm>
#include <utility>

#include "devices/projector_control/pjlink_login.h"
#include "viewer/remote/http_guard.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kRandomDigits = 8;
constexpr std::size_t kMd5Digits = 32;
constexpr std::size_t kRandom256Digits = 32;
constexpr std::size_t kSha256Digits = 64;
constexpr std::size_t kLongestCommand = 136;
constexpr std::size_t kLongestLine = kLongestCommand + kRandom256Digits + kSha256Digits;

bool isHex(std::string_view text) {
  return std::ranges::all_of(
      text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); });
}

void toUpper(std::string& text) {
  for (char& letter : text) {
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  }
}

}  // namespace

std::string PjlinkSession::freshRandom(std::size_t digits) {
  return devices::pjlinkRandom().substr(0, digits);
}

PjlinkSession::PjlinkSession(std::string password, Obey obey, Random random)
    : password_(std::move(password)), obey_(std::move(obey)), makeRandom_(std::move(random)), isIn_(password_.empty()) {
  if (!isIn_) random_ = makeRandom_(kRandomDigits);
}

std::string PjlinkSession::greeting() const {
  return isIn_ ? "PJLINK 0\r" : "PJLINK 1 " + random_ + "\r";
}

std::string PjlinkSession::receive(std::string_view bytes) {
  typed_ += bytes;
  std::string answers;
  while (!wantsClose()) {
    const auto end = typed_.find('\r');
    if (std::min(end, typed_.size()) > kLongestLine) closes_ = true;
    if (closes_ || end == std::string::npos) break;
    std::string line = typed_.substr(0, end);
    typed_.erase(0, end + 1);
    if (line.starts_with('\n')) line.erase(0, 1);  // of those who end lines with both
    answers += hear(std::move(line));
  }
  return answers;
}

std::string PjlinkSession::hear(std::string line) {
  if (!isIn_ && line == "PJLINK 2" && random256_.empty()) {
    random256_ = makeRandom_(kRandom256Digits);
    return "PJLINK 2 " + random256_ + "\r";
  }
  if (!isIn_ && !letIn(line)) {
    refused_ = true;
    return "PJLINK ERRA\r";
  }
  if (line.size() < 7 || line.size() > kLongestCommand || line[0] != '%' || line[6] != ' ') return {};  // no command
  std::string body = line.substr(2, 4);
  toUpper(body);
  if (!std::ranges::all_of(body, [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); })) return {};
  if (line[1] < '0' || line[1] > '9') return {};
  return line.substr(0, 2) + body + "=" + obey_(line[1], body, std::string_view(line).substr(7)) + "\r";
}

bool PjlinkSession::letIn(std::string& line) {
  std::size_t digits = kMd5Digits;
  std::string expected;
  if (random256_.empty()) {
    expected = devices::pjlinkMd5(random_, password_);
  } else {
    digits = kRandom256Digits + kSha256Digits;
    const std::string theirs = line.substr(0, kRandom256Digits);
    if (theirs.size() < kRandom256Digits || !isHex(theirs)) return false;
    expected = devices::pjlinkSha256(random256_, theirs, password_);
  }
  isIn_ = isSameSecret(line.substr(0, digits), expected);
  if (isIn_) line.erase(0, digits);
  return isIn_;
}

}  // namespace pixelflex::viewer
