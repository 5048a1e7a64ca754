#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <utility>

#include "devices/projector_control/drivers.h"
#include "devices/projector_control/pjlink_login.h"
#include "devices/projector_control/projector_driver.h"

namespace pixelflex::devices {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTimeout{5000};
// Connections are to be closed when there is nothing more to say; the projector does it after 30 s.
constexpr milliseconds kIdleClose{2000};
constexpr milliseconds kLoginTimeout{2000};

struct Item {
  std::string_view name;
  std::string_view body;
  char itsClass;
};
constexpr std::array kItems = {Item{"power", "POWR", '1'},  Item{"input", "INPT", '1'},
                               Item{"mute", "AVMT", '1'},   Item{"freeze", "FREZ", '2'},
                               Item{"hours", "LAMP", '1'},  Item{"filter_hours", "FILT", '2'},
                               Item{"errors", "ERST", '1'}, Item{"resolution", "IRES", '2'}};
constexpr std::array<std::string_view, 7> kSources = {"", "rgb", "video", "digital", "storage", "network", "internal"};
constexpr std::array<std::string_view, 4> kPowerStates = {"off", "on", "cooling", "warming"};
constexpr std::array<std::string_view, 6> kParts = {"fan", "lamp", "temperature", "cover", "filter", "other"};

/// "31" as "digital1".
std::string inputName(std::string_view code) {
  const bool known = code.size() == 2 && code[0] >= '1' && code[0] <= '6';
  if (!known) return "input " + std::string(code);
  return std::string(kSources.at(static_cast<std::size_t>(code[0] - '0'))) + code[1];
}

/// Six digits: each a part, 0 well, 1 a warning, 2 an error.
std::string errorsText(std::string_view digits) {
  std::string text;
  for (std::size_t i = 0; i < std::min(digits.size(), kParts.size()); ++i) {
    if (digits[i] != '1' && digits[i] != '2') continue;
    text += (text.empty() ? "" : ", ") + std::string(kParts.at(i)) + (digits[i] == '1' ? " warning" : " error");
  }
  return text.empty() ? "none" : text;
}

class Pjlink : public ProjectorDriver {
 public:
  Pjlink(LineLoop& loop, const LineAddress& address, const std::string& name, std::string password)
      : ProjectorDriver(loop, address, name, {.device = name, .idleClose = kIdleClose}),
        password_(std::move(password)) {}

 protected:
  std::string doIdentity() override {
    std::string text;
    for (const auto* body : {"INF1", "INF2", "NAME"}) {
      const std::string part = ask('1', body, "?");
      if (!isError(part) && !part.empty()) text += (text.empty() ? "" : " ") + part;
    }
    return text + " (PJLink class " + std::string(1, theirClass()) + ")";
  }

  std::vector<SettingInfo> doSettings() override {
    if (!settings_.empty()) return settings_;
    std::vector<SettingInfo> found;
    for (const Item& item : kItems) {
      if (item.itsClass > theirClass()) continue;
      if (item.name != "power" && ask(item.itsClass, item.body, "?") == "ERR1") continue;
      found.push_back(describe(item));
    }
    settings_ = std::move(found);
    return settings_;
  }

  SettingValue doRead(const SettingInfo& setting) override {
    const Item& item = itemOf(setting);
    const std::string text = demand(item, "?");
    if (setting.name == "power") {
      const bool known = text.size() == 1 && text[0] >= '0' && text[0] <= '3';
      return std::string(known ? kPowerStates.at(static_cast<std::size_t>(text[0] - '0')) : "unknown");
    }
    if (setting.name == "input") return inputName(text);
    if (setting.name == "mute") return onOffValue(text == "11" || text == "31");
    if (setting.name == "freeze") return onOffValue(text == "1");
    if (setting.name == "errors") return errorsText(text);
    if (setting.name == "resolution") return text == "-" ? "no signal" : text == "*" ? "unknown" : text;
    int hours = 0;
    (void)std::from_chars(text.data(), text.data() + text.size(), hours);
    return 1.0 * hours;
  }

  void doWrite(const SettingInfo& setting, const SettingValue& value, const Progress& progress) override {
    const Item& item = itemOf(setting);
    if (setting.name == "power") return setPower(item, isOn(value), progress);
    if (setting.name == "freeze") return (void)demand(item, isOn(value) ? "1" : "0");
    if (setting.name == "mute") return setMute(item, isOn(value));
    const auto place = std::ranges::find(setting.choices, std::get<std::string>(value)) - setting.choices.begin();
    (void)demand({item.name, item.body, inputsClass_}, inputCodes_.at(static_cast<std::size_t>(place)));
  }

 private:
  static const Item& itemOf(const SettingInfo& setting) {
    return *std::ranges::find(kItems, setting.name, &Item::name);
  }
  static bool isError(const std::string& text) { return text.size() == 4 && text.starts_with("ERR"); }

  SettingInfo describe(const Item& item) {
    const std::string name(item.name);
    if (name == "power") return onOff(name, true);
    if (name == "mute" || name == "freeze") return onOff(name);
    if (name == "hours" || name == "filter_hours") return reading(name, "h");
    if (name != "input") return reading(name, "");
    readInputs();
    std::vector<std::string> names;
    for (const auto& code : inputCodes_) names.push_back(inputName(code));
    return words(name, std::move(names));
  }

  /// Class 2 knows more of them.
  void readInputs() {
    inputsClass_ = theirClass();
    std::string list = ask(inputsClass_, "INST", "?");
    if (isError(list)) list.clear();
    inputCodes_.clear();
    while (!list.empty()) {
      const auto cut = list.find(' ');
      if (cut != 0) inputCodes_.push_back(list.substr(0, cut));
      list.erase(0, cut == std::string::npos ? list.size() : cut + 1);
    }
  }

  char theirClass() {
    if (class_ == 0) class_ = ask('1', "CLSS", "?") == "2" ? '2' : '1';
    return class_;
  }

  void setPower(const Item& item, bool on, const Progress& progress) {
    const auto state = [&] { return std::get<std::string>(doRead(onOff("power"))); };
    const std::string wanted = on ? "on" : "off";
    const std::string doing = on ? "warming up" : "cooling down";
    // Not while the lamp is changing, and then only when it is not as wanted.
    waitUntil([&] { return state() == "on" || state() == "off"; }, kLampTime, progress, "the lamp is changing");
    if (state() == wanted) return;
    (void)demand(item, on ? "1" : "0");
    waitUntil([&] { return state() == wanted; }, kLampTime, progress, doing);
  }

  /// The picture alone where that can be; some projectors only mute picture and sound together.
  void setMute(const Item& item, bool on) {
    if (ask(item.itsClass, item.body, on ? "11" : "10") != "OK") (void)demand(item, on ? "31" : "30");
  }

  /// Throws for the protocol's errors.
  std::string demand(const Item& item, const std::string& value) {
    const std::string what(item.name);
    std::string text = ask(item.itsClass, item.body, value);
    if (text == "ERR1") complain("it has no " + what);
    if (text == "ERR2") complain(what + ": it does not know that value");
    if (text == "ERR3") complain(what + ": not now; it is in standby, warming up or cooling down");
    if (text == "ERR4") complain(what + ": it reports a failure of its own: read errors");
    return text;
  }

  /// The text behind "=". A connection that went away in between is made once more.
  std::string ask(char itsClass, std::string_view body, const std::string& value) {
    for (int attempt = 1; true; ++attempt) {
      try {
        if (const auto text = tryAsk(itsClass, body, value)) return *text;
      } catch (const LineError& error) {
        session_ = 0;
        const bool mayHeal = error.failure() == LineFailure::kLost || error.failure() == LineFailure::kSilent;
        if (attempt > 1 || !mayHeal) throw;
        continue;
      }
      session_ = 0;
      if (attempt > 1) complain("its answers are no PJLink");
    }
  }

  std::optional<std::string> tryAsk(char itsClass, std::string_view body, const std::string& value) {
    if (session_ == 0 || session_ != line().session() || !line().isConnected()) logIn();
    const std::string head = std::string{'%', itsClass} + std::string(body);
    const std::string command = std::exchange(prefix_, "") + head + " " + value + "\r";
    const std::string reply = line().ask({.bytes = command, .end = untilText("\r"), .timeout = kTimeout});
    if (reply.starts_with("PJLINK ERRA")) {
      refused_ = true;
      complain("it refuses the password");
    }
    const bool sound = line().session() == session_ && reply.starts_with(head + "=");
    if (!sound) return std::nullopt;
    return reply.substr(head.size() + 1, reply.size() - head.size() - 2);
  }

  void logIn() {
    // Projectors lock those out who try again and again.
    if (refused_) complain("it refuses the password");
    std::string greeting = greet();
    if (greeting.starts_with("PJLINK 0")) return;
    if (!greeting.starts_with("PJLINK 1 ")) complain("it does not greet as PJLink does: is that its port?");
    if (password_.empty()) complain("it asks for a password: give control a password_file");
    if (const auto random = newerRandom()) {
      prefix_ = pjlinkSha256(*random, pjlinkRandom(), password_);
      return;
    }
    if (!line().isConnected() || line().session() != session_) greeting = greet();
    if (!greeting.starts_with("PJLINK 1 ")) complain("it greets differently each time: is that a PJLink port?");
    prefix_ = pjlinkMd5(std::string_view(greeting).substr(9), password_);
  }

  std::string greet() {
    line().disconnect();
    prefix_.clear();
    std::string greeting = line().ask({.bytes = "", .end = untilText("\r"), .timeout = kTimeout, .keepEarlier = true});
    session_ = line().session();
    greeting.pop_back();
    return greeting;
  }

  /// What a projector of version 2.10 answers; older ones do not, and get a new connection.
  std::optional<std::string> newerRandom() {
    if (!sha256_) return std::nullopt;
    try {
      const std::string reply = line().ask({.bytes = "PJLINK 2\r", .end = untilText("\r"), .timeout = kLoginTimeout});
      if (reply.starts_with("PJLINK 2 ")) return reply.substr(9, reply.size() - 10);
    } catch (const LineError& error) {
      if (error.failure() != LineFailure::kSilent && error.failure() != LineFailure::kLost) throw;
    }
    sha256_ = false;
    session_ = 0;
    return std::nullopt;
  }

  std::string password_;
  std::uint64_t session_ = 0;  // the connection that was logged in to
  std::string prefix_;         // of its first command
  bool sha256_ = true;
  bool refused_ = false;
  char class_ = 0;
  char inputsClass_ = '1';
  std::vector<std::string> inputCodes_;
  std::vector<SettingInfo> settings_;
};

}  // namespace

std::unique_ptr<Device> makePjlink(LineLoop& loop, const LineAddress& address, const std::string& name,
                                   const std::string& password) {
  return std::make_unique<Pjlink>(loop, address, name, password);
}

}  // namespace pixelflex::devices
