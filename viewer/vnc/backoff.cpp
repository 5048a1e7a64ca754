#include "viewer/vnc/backoff.h"

#include <algorithm>

namespace pixelflex::viewer {
namespace {

using std::chrono::milliseconds;

// A connection that held so long was a good one: what follows it is a new loss.
constexpr std::chrono::seconds kGood{2};

bool talksNonsense(CloseKind kind) {
  return kind == CloseKind::kNotVnc || kind == CloseKind::kProtocol;
}

}  // namespace

bool mayHeal(CloseKind kind) {
  switch (kind) {
    case CloseKind::kUnreachable:
    case CloseKind::kNotVnc:
    case CloseKind::kLost:
    case CloseKind::kProtocol:
      return true;
    case CloseKind::kPasswordNeeded:
    case CloseKind::kAuthentication:
    case CloseKind::kUntrusted:
    case CloseKind::kTooLarge:
    case CloseKind::kUnsupported:
      break;
  }
  return false;
}

milliseconds Backoff::after(CloseKind kind, std::chrono::steady_clock::duration lasted) {
  if (lasted >= kGood) failures_ = 0;
  failures_ = std::min(failures_ + 1, 100);
  if (talksNonsense(kind)) return std::min(failures_ * milliseconds(500), milliseconds(5000));
  return std::min(failures_ * milliseconds(100), milliseconds(500));
}

}  // namespace pixelflex::viewer
