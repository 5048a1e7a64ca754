#include "viewer/panel/panel_context.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace pixelflex::viewer {

void PanelContext::attempt(const std::function<void()>& action) const {
  try {
    action();
  } catch (const std::exception& error) {
    console.log(LogLine::Kind::kError, error.what());
  }
}

int PanelContext::device(const std::string& names, const std::vector<std::string>& steps) const {
  int job = 0;
  attempt([&] { job = console.device(names, steps); });
  return job;
}

std::vector<std::string> PanelContext::chosen() const {
  std::vector<std::string> names;
  for (const auto& projector : wall->wall->projectors) {
    if (choice.projectors.contains(projector.name)) names.push_back(projector.name);
  }
  return names;
}

std::vector<const DeviceState*> PanelContext::chosenDevices(bool mirrors) const {
  std::vector<const DeviceState*> found;
  for (const auto& state : wall->devices) {
    if (state->device.isMirror == mirrors && choice.projectors.contains(state->device.projector)) {
      found.push_back(state.get());
    }
  }
  return found;
}

std::string PanelContext::namesOf(const std::vector<const DeviceState*>& devices) const {
  if (devices.empty()) return "";
  const auto alike = std::ranges::count_if(
      wall->devices, [&](const auto& state) { return state->device.isMirror == devices.front()->device.isMirror; });
  if (devices.size() > 1 && std::cmp_equal(devices.size(), alike)) return "all";
  std::string names;
  for (const auto* state : devices) names += (names.empty() ? "" : ",") + state->device.name;
  return names;
}

const ConsoleJob* PanelContext::longJob() const {
  for (const auto& job : wall->jobs) {
    if (job.running && job.kind != ConsoleJob::Kind::kDevice) return &job;
  }
  return nullptr;
}

}  // namespace pixelflex::viewer
