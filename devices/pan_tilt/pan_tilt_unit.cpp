#include "devices/pan_tilt/pan_tilt_unit.h"

#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

#include "devices/pan_tilt/pan_tilt_reply.h"

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

// Ramps are tabulated anew when these change.
constexpr milliseconds kTableTimeout{8000};
constexpr milliseconds kResetTimeout{30000};
constexpr milliseconds kPoll{100};
constexpr milliseconds kStalled{1500};
constexpr milliseconds kDrain{200};
// Ends a command that was typed by half: a blank alone would carry it out, and "PP12" may have been meant to be
// "PP1200".
constexpr const char* kNonsense = "Z ";
constexpr int kHaltAttempts = 3;
constexpr int kLostPolls = 2;

char letterOf(PanTiltAxis axis) {
  return axis == PanTiltAxis::kPan ? 'P' : 'T';
}

std::string wordOf(PanTiltAxis axis) {
  return axis == PanTiltAxis::kPan ? "pan" : "tilt";
}

std::string command(PanTiltAxis axis, char what, std::optional<int> value = std::nullopt) {
  return std::string{letterOf(axis), what} + (value ? std::to_string(*value) : "");
}

Exchange exchangeOf(const std::string& command, milliseconds timeout) {
  // What came by itself before may be the news of a stop.
  return {.bytes = command + " ", .end = endOfPanTiltReply, .timeout = timeout, .keepEarlier = true};
}

LineOptions optionsOf(const std::string& name) {
  return {.device = name, .resync = kNonsense};
}

}  // namespace

int PanTiltMotor::counts(double degrees) const {
  return static_cast<int>(std::lround(degrees / degreesPerCount));
}

PanTiltUnit::PanTiltUnit(LineLoop& loop, const LineAddress& address, const std::string& name)
    : name_(name), line_(loop, address, optionsOf(name)) {}

PanTiltUnit::~PanTiltUnit() {
  if (moving_) haltQuietly();
  if (!line_.isConnected() || line_.session() != readySession_) return;
  if (foundVerbose_) say("FV");
  if (foundEcho_) say("EE");
}

void PanTiltUnit::complain(const std::string& what) const {
  throw DeviceError(line_.name() + ": " + what);
}

/// Once more when a reply got lost: nothing that is asked here does more when it is done twice.
std::string PanTiltUnit::askTwice(const Exchange& exchange) {
  try {
    return line_.ask(exchange);
  } catch (const LineError& error) {
    if (error.failure() != LineFailure::kSilent) throw;
  }
  return line_.ask(exchange);
}

std::string PanTiltUnit::ask(const std::string& command, milliseconds timeout) {
  const PanTiltReply reply = parsePanTiltReply(askTwice(exchangeOf(command, timeout)));
  panStops_ += reply.panStops;
  tiltStops_ += reply.tiltStops;
  if (!reply.success) complain("it refuses \"" + command + "\": " + reply.text);
  return reply.text;
}

double PanTiltUnit::askReal(const std::string& command) {
  const std::string text = ask(command);
  const auto number = numberInReply(text);
  if (!number) complain("its answer to \"" + command + "\" has no number: \"" + text + "\"");
  return *number;
}

int PanTiltUnit::askNumber(const std::string& command) {
  return static_cast<int>(std::lround(askReal(command)));
}

void PanTiltUnit::say(const std::string& command) noexcept {
  try {
    (void)line_.ask(exchangeOf(command, kUsualTimeout));
  } catch (const LineError&) {
    // The modes are a courtesy to whoever comes next.
  }
}

/// Whatever was typed before us, and whatever modes the unit was left in.
void PanTiltUnit::makeReady() {
  if (readySession_ != 0 && readySession_ == line_.session()) return;
  try {
    (void)line_.ask({.bytes = kNonsense, .end = [](std::string_view) { return std::nullopt; }, .timeout = kDrain});
  } catch (const LineError& error) {
    if (error.failure() != LineFailure::kSilent) throw;
  }
  const std::uint64_t session = line_.session();
  learnModes();
  ask("ED");
  ask("FT");
  // Old firmware knows no other mode than the one wanted.
  for (const auto* mode : {"CI", "I"}) (void)line_.ask(exchangeOf(mode, kUsualTimeout));
  version_ = ask("V");
  for (const auto axis : {PanTiltAxis::kPan, PanTiltAxis::kTilt}) readMotor(axis);
  readySession_ = session;
}

void PanTiltUnit::learnModes() {
  if (readySession_ != 0) return;  // after a lost line it is in our own modes, or has been switched off
  const auto has = [this](const char* question, const char* word) {
    return parsePanTiltReply(line_.ask(exchangeOf(question, kUsualTimeout))).text.find(word) != std::string::npos;
  };
  foundEcho_ = has("E", "ON");
  foundVerbose_ = has("F", "verbose");
}

void PanTiltUnit::readMotor(PanTiltAxis axis) {
  constexpr double kArcSeconds = 3600;
  PanTiltMotor& motor = motors_.at(static_cast<std::size_t>(axis));
  motor.degreesPerCount = askReal(command(axis, 'R')) / kArcSeconds;
  motor.minimum = askNumber(command(axis, 'N'));
  motor.maximum = askNumber(command(axis, 'X'));
  motor.lower = askNumber(command(axis, 'L'));
  motor.upper = askNumber(command(axis, 'U'));
  motor.speed = askNumber(command(axis, 'S'));
  motor.acceleration = askNumber(command(axis, 'A'));
  motor.base = askNumber(command(axis, 'B'));
  if (!(motor.degreesPerCount > 0)) complain("it gives no resolution of its " + wordOf(axis) + " axis");
}

const std::string& PanTiltUnit::version() {
  makeReady();
  return version_;
}

const PanTiltMotor& PanTiltUnit::motor(PanTiltAxis axis) {
  makeReady();
  return motors_.at(static_cast<std::size_t>(axis));
}

int PanTiltUnit::position(PanTiltAxis axis) {
  makeReady();
  return askNumber(command(axis, 'P'));
}

int PanTiltUnit::target(PanTiltAxis axis) {
  makeReady();
  return askNumber(command(axis, 'O'));
}

void PanTiltUnit::setSpeed(PanTiltAxis axis, int countsPerSecond) {
  makeReady();
  ask(command(axis, 'S', countsPerSecond));
  motors_.at(static_cast<std::size_t>(axis)).speed = askNumber(command(axis, 'S'));
}

void PanTiltUnit::setAcceleration(PanTiltAxis axis, int countsPerSecondSquared) {
  makeReady();
  ask(command(axis, 'A', countsPerSecondSquared), kTableTimeout);
  motors_.at(static_cast<std::size_t>(axis)).acceleration = askNumber(command(axis, 'A'));
}

bool PanTiltUnit::limitsEnabled() {
  makeReady();
  return ask("L").find("DISABLED") == std::string::npos;
}

void PanTiltUnit::setLimitsEnabled(bool enabled) {
  makeReady();
  ask(enabled ? "LE" : "LD");
}

void PanTiltUnit::checkTarget(PanTiltAxis axis, std::optional<int> target) {
  if (!target) return;
  const PanTiltMotor& its = motors_.at(static_cast<std::size_t>(axis));
  if (its.minimum >= its.maximum) complain("it does not know its limits: reset it");
  if (*target >= its.minimum && *target <= its.maximum) return;
  const auto place = [&](int counts) {
    return std::to_string(counts) + " counts (" + textOf(its.degrees(counts)) + " deg)";
  };
  complain(wordOf(axis) + " cannot go to " + place(*target) + ", only from " + place(its.minimum) + " to " +
           place(its.maximum));
}

void PanTiltUnit::moveTo(std::optional<int> pan, std::optional<int> tilt, const Progress& progress) {
  haltsBefore_ = halts_;
  makeReady();
  checkTarget(PanTiltAxis::kPan, pan);
  checkTarget(PanTiltAxis::kTilt, tilt);
  panStops_ = tiltStops_ = 0;
  moving_ = true;
  try {
    if (pan) ask(command(PanTiltAxis::kPan, 'P', *pan));
    if (tilt) ask(command(PanTiltAxis::kTilt, 'P', *tilt));
    follow({pan, tilt}, progress);
  } catch (const std::runtime_error&) {
    // Somebody else's halt is the reason, whatever became of the last question.
    if (halts_ != haltsBefore_) complain("halted");
    haltQuietly();
    throw;
  }
  if (halts_ != haltsBefore_) complain("halted");
  moving_ = false;
}

/// What was sent before may have arrived. When that fails as well, the first error says more.
void PanTiltUnit::haltQuietly() noexcept {
  try {
    halt();
  } catch (const std::runtime_error&) {
    // The unit is out of reach.
  }
}

/// Where the axes that move are; nothing when a reply got lost, as one may on a long cable.
std::optional<PanTiltUnit::Places> PanTiltUnit::look(const Places& target, int& lost) {
  try {
    Places now;
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (target[i]) now[i] = position(static_cast<PanTiltAxis>(i));
    }
    lost = 0;
    return now;
  } catch (const LineError& error) {
    if (error.failure() != LineFailure::kSilent || ++lost >= kLostPolls) throw;
    return std::nullopt;
  }
}

void PanTiltUnit::complainOfStops() const {
  if (panStops_ + tiltStops_ == 0) return;
  const std::string axis = wordOf(panStops_ > 0 ? PanTiltAxis::kPan : PanTiltAxis::kTilt);
  complain(axis + " ran into its stop: its counts are wrong now, reset it");
}

void PanTiltUnit::complainOfStall(const Places& now, const Places& target) const {
  const std::size_t axis = now[0] != target[0] ? 0 : 1;
  complain(wordOf(static_cast<PanTiltAxis>(axis)) + " stays at " + std::to_string(now[axis].value_or(0)) +
           " counts instead of going to " + std::to_string(target[axis].value_or(0)) + ": is it blocked?");
}

void PanTiltUnit::follow(const Places& target, const Progress& progress) {
  auto lastProgress = Clock::now();
  Places last;
  for (int lost = 0; true;) {
    if (progress.stop.stop_requested() || halts_ != haltsBefore_) complain("stopped on request");
    const auto now = look(target, lost);
    if (!now) continue;
    complainOfStops();
    if (*now == target) return;
    const auto time = Clock::now();
    if (std::exchange(last, *now) != *now) lastProgress = time;
    if (time - lastProgress > kStalled) complainOfStall(*now, target);
    int left = 0;
    for (std::size_t i = 0; i < target.size(); ++i) left += std::abs(target[i].value_or(0) - (*now)[i].value_or(0));
    progress.tell(std::to_string(left) + " counts to go");
    std::this_thread::sleep_for(kPoll);
  }
}

void PanTiltUnit::reset(const Progress& progress) {
  makeReady();
  progress.tell("both axes run to their stops");
  moving_ = true;
  ask("R", kResetTimeout);
  moving_ = false;
  panStops_ = tiltStops_ = 0;
  for (const auto axis : {PanTiltAxis::kPan, PanTiltAxis::kTilt}) readMotor(axis);
}

void PanTiltUnit::halt() {
  ++halts_;
  for (int attempt = 1; true; ++attempt) {
    try {
      Exchange exchange = exchangeOf("H", kUsualTimeout);
      exchange.urgent = true;
      if (parsePanTiltReply(line_.ask(std::move(exchange))).success) break;
    } catch (const LineError&) {
      if (attempt >= kHaltAttempts) throw;
    }
    if (attempt >= kHaltAttempts) complain("it refuses to halt");
  }
  moving_ = false;
}

}  // namespace pixelflex::devices
