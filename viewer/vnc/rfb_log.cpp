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
  // It adds a made-up errno to what GnuTLS said.
  const bool told = line.starts_with("read (") && last_.starts_with("Error reading from TLS");
  if (!told) last_ = std::move(line);
}

}  // namespace pixelflex::viewer
