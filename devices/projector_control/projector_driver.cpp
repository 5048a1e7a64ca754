#include "devices/projector_control/projector_driver.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <future>
#include <thread>
#include <utility>

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kPoll{250};
constexpr int kIdleSteps = 3;

std::string secondsSince(Clock::time_point begun) {
  return std::to_string(std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - begun).count()) + " s";
}

}  // namespace

ProjectorDriver::ProjectorDriver(LineLoop& loop, const LineAddress& address, const std::string& name,
                                 LineOptions options)
    : Device(name), line_(loop, address, std::move(options)) {}

void ProjectorDriver::complain(const std::string& what) const {
  throw DeviceError(line_.name() + ": " + what);
}

std::string ProjectorDriver::askTwice(const Exchange& exchange) {
  try {
    return line_.ask(exchange);
  } catch (const LineError& error) {
    if (error.failure() != LineFailure::kSilent && error.failure() != LineFailure::kLost) throw;
  }
  return line_.ask(exchange);
}

std::string ProjectorDriver::askSlowly(const Exchange& exchange, const Progress& progress, const std::string& state) {
  const auto promise = std::make_shared<std::promise<Line::Answer>>();
  auto future = promise->get_future();
  line_.submit(exchange, [promise](Line::Answer answer) { promise->set_value(std::move(answer)); });
  const auto begun = Clock::now();
  while (future.wait_for(kPoll) == std::future_status::timeout) {
    progress.tell(state + ", " + secondsSince(begun));
    if (!progress.stop.stop_requested()) continue;
    line_.disconnect();
    complain("no longer waited for on request; it goes on by itself");
  }
  Line::Answer answer = future.get();
  if (const auto* problem = std::get_if<LineProblem>(&answer)) throw LineError(*problem);
  return std::get<std::string>(std::move(answer));
}

void ProjectorDriver::waitUntil(const std::function<bool()>& reached, milliseconds timeout, const Progress& progress,
                                const std::string& state) {
  const auto begun = Clock::now();
  while (true) {
    try {
      if (reached()) return;
    } catch (const LineError& error) {
      if (Clock::now() - begun > timeout) throw;
    } catch (const DeviceError& error) {
      if (Clock::now() - begun > timeout) throw;
    }
    if (progress.stop.stop_requested()) complain("no longer waited for on request; it goes on by itself");
    if (Clock::now() - begun > timeout) complain(state + " for " + secondsSince(begun) + " already: see to it");
    progress.tell(state + ", " + secondsSince(begun));
    std::this_thread::sleep_for(kPoll);
  }
}

void ProjectorDriver::driveTo(const SettingInfo& setting, int target, const std::function<int()>& read,
                              const std::function<void(int direction)>& step, const Progress& progress) {
  int idle = 0;
  for (int now = read(); now != target;) {
    if (progress.stop.stop_requested()) complain(setting.name + ": stopped on request at " + std::to_string(now));
    // All steps at once, then a look at what came of them.
    const int ahead = std::abs(target - now);
    for (int i = 0; i < ahead && !progress.stop.stop_requested(); ++i) {
      step(target > now ? 1 : -1);
      progress.tell(setting.name + " " + std::to_string(ahead - i) + " steps to go");
    }
    const int then = read();
    idle = std::abs(target - then) < ahead ? 0 : idle + 1;
    if (idle >= kIdleSteps) {
      complain(setting.name + " stays at " + std::to_string(then) + " instead of going to " + std::to_string(target));
    }
    now = then;
  }
}

void ProjectorDriver::countTo(const SettingInfo& setting, int target, const std::function<void(int steps)>& turn,
                              const std::function<void()>& toLowerEnd) {
  auto known = places_.extract(setting.name);  // unknown again if something goes wrong on the way
  if (known.empty()) toLowerEnd();
  turn(target - (known.empty() ? 0 : known.mapped()));
  places_[setting.name] = target;
}

void ProjectorDriver::turnBy(const SettingInfo& setting, int steps, const std::function<void(int steps)>& turn) {
  const auto known = places_.extract(setting.name);
  turn(steps);
  if (known.empty()) return;
  const int place = known.mapped() + steps;
  if (place >= 0 && place <= static_cast<int>(setting.maximum)) places_[setting.name] = place;
}

SettingInfo ProjectorDriver::onOff(const std::string& name, bool slow) {
  return {.name = name, .choices = {"on", "off"}, .words = true, .slow = slow};
}

SettingInfo ProjectorDriver::number(const std::string& name, int minimum, int maximum) {
  return {.name = name, .minimum = 1.0 * minimum, .maximum = 1.0 * maximum, .nudgeable = true};
}

SettingInfo ProjectorDriver::motor(const std::string& name, int steps) {
  return {.name = name,
          .unit = "steps",
          .maximum = 1.0 * steps,
          .readable = false,
          .nudgeable = true,
          .slow = true,
          .approximate = true};
}

SettingInfo ProjectorDriver::reading(const std::string& name, const std::string& unit) {
  return {.name = name, .unit = unit, .words = unit.empty(), .settable = false};
}

SettingInfo ProjectorDriver::words(const std::string& name, std::vector<std::string> choices) {
  return {.name = name, .choices = std::move(choices), .words = true};
}

int ProjectorDriver::wholeNumber(const SettingValue& value) {
  return static_cast<int>(std::lround(std::get<double>(value)));
}

}  // namespace pixelflex::devices
