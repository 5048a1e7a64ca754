#include "viewer/vnc/event_queue.h"

#include <algorithm>
#include <utility>

namespace pixelflex::viewer {
namespace {

constexpr std::ptrdiff_t kMostOfAKind = 8;

bool isAboutTheConnection(const SessionEvent& event) {
  return std::holds_alternative<Connected>(event) || std::holds_alternative<Lost>(event) ||
         std::holds_alternative<Closed>(event);
}

}  // namespace

void appendEvent(std::vector<SessionEvent>& events, SessionEvent event) {
  const auto isAlike = [&event](const SessionEvent& other) { return other.index() == event.index(); };
  if (!isAboutTheConnection(event) && std::ranges::count_if(events, isAlike) >= kMostOfAKind) {
    events.erase(std::ranges::find_if(events, isAlike));
  }
  events.push_back(std::move(event));
}

}  // namespace pixelflex::viewer
