#include "viewer/vnc/rfb_log.h"

#include <rfb/rfbclient.h>

#include <array>
#include <cassert>
#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <utility>

namespace pixelflex::viewer {
namespace {

thread_local RfbLog* logOfThread = nullptr;

[[gnu::format(printf, 1, 2)]] void catchLine(const char* format, ...) {
  if (logOfThread == nullptr) return;
  std::array<char, 512> line{};
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  logOfThread->add(line.data());
}

bool tellsTheEnd(const std::string& line) {
  return line == "VNC server closed connection" || line == "Connection timed out" ||
         line.starts_with("Error reading from TLS");
}

void installOnce() {
  static std::once_flag once;
  std::call_once(once, [] {
    rfbClientLog = catchLine;
    rfbClientErr = catchLine;
  });
}

}  // namespace

RfbLog::RfbLog() {
  assert(logOfThread == nullptr);
  installOnce();
  logOfThread = this;
}

RfbLog::~RfbLog() {
  logOfThread = nullptr;
}

void RfbLog::add(std::string line) {
  while (!line.empty() && line.back() == '\n') line.pop_back();
  damaged_ |= line.starts_with("ZRLE decoding failed") || line.find("out of bounds") != std::string::npos;
  // What the connection's end brings with it, made-up error numbers and complaints of missing data, hides it.
  if (!tellsTheEnd(last_)) last_ = std::move(line);
}

}  // namespace pixelflex::viewer
