#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "devices/simulate/projector_simulator.h"

namespace pixelflex::devices {
namespace {

using Power = ProjectorState::Power;

constexpr std::size_t kLongest = 136;
constexpr std::size_t kMd5Digits = 32;
constexpr std::size_t kShaDigits = 64;

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    text += kDigits[static_cast<unsigned char>(byte) >> 4U];
    text += kDigits[static_cast<unsigned char>(byte) & 15U];
  }
  return text;
}

std::string digest(gnutls_digest_algorithm_t algorithm, const std::string& text) {
  std::string bytes(gnutls_hash_get_len(algorithm), '\0');
  gnutls_hash_fast(algorithm, text.data(), text.size(), bytes.data());
  return hex(bytes);
}

std::string randomHex(std::size_t bytes) {
  std::string random(bytes, '\0');
  gnutls_rnd(GNUTLS_RND_NONCE, random.data(), random.size());
  return hex(random);
}

int digitOf(char digit) {
  return digit <= '9' ? digit - '0' : (digit | 0x20) - 'a' + 10;
}

/// Of two texts of hexadecimal digits.
std::string exclusiveOr(const std::string& a, const std::string& b) {
  std::string result;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    result += "0123456789abcdef"[static_cast<unsigned>(digitOf(a[i]) ^ digitOf(b[i])) & 15U];
  }
  return result;
}

class PjlinkSimulator : public ProjectorSimulator {
 public:
  explicit PjlinkSimulator(PjlinkSimulatorOptions options) : options_(std::move(options)) { state().input = 31; }

  void connected(Time now) override {
    typed_.clear();
    forgetOutput();
    setWantsClose(false);
    random_ = randomHex(4);
    random256_.clear();
    let_ = options_.password.empty();
    say(let_ ? "PJLINK 0\r" : "PJLINK 1 " + random_ + "\r", now);
  }

  void receive(std::string_view bytes, Time now) override {
    advance(now);
    typed_ += bytes;
    for (auto end = typed_.find('\r'); end != std::string::npos; end = typed_.find('\r')) {
      const std::string line = typed_.substr(0, end);
      typed_.erase(0, end + 1);
      hear(line, now);
    }
    if (typed_.size() > 2 * kLongest) typed_.clear();
  }

 private:
  void hear(std::string line, Time now) {
    if (!let_ && line == "PJLINK 2" && options_.sha256) {
      random256_ = randomHex(16);
      return say("PJLINK 2 " + random256_ + "\r", now);
    }
    if (!let_ && !letIn(line)) {
      say("PJLINK ERRA\r", now);
      return setWantsClose(true);
    }
    if (line.size() < 7 || line[0] != '%' || line[6] != ' ') return;  // not even a command
    std::ranges::transform(line.begin() + 2, line.begin() + 6, line.begin() + 2,
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    say(line.substr(0, 6) + "=" + obey(line[1], line.substr(2, 4), line.substr(7)) + "\r", now);
  }

  /// Takes the digest off the front of the first command.
  bool letIn(std::string& line) {
    std::string expected = digest(GNUTLS_DIG_MD5, random_ + options_.password);
    if (!random256_.empty() && line.size() > kMd5Digits) {
      const std::string theirs = line.substr(0, kMd5Digits);
      expected = theirs + digest(GNUTLS_DIG_SHA256, exclusiveOr(random256_, theirs) + options_.password);
    }
    let_ = line.starts_with(expected);
    if (let_) line.erase(0, expected.size());
    return let_;
  }

  std::string obey(char itsClass, const std::string& body, const std::string& value) {
    if (itsClass != '1' && (itsClass != '2' || options_.pjlinkClass < 2)) return "ERR1";
    if (suffers(Fault::kBusy)) return "ERR3";
    if (body == "POWR") return power(value);
    if (value == "?") return get(itsClass, body);
    if (!state().isOn()) return "ERR3";
    return set(itsClass, body, value);
  }

  std::string power(const std::string& value) {
    if (value != "?" && value != "0" && value != "1") return "ERR2";
    if (value != "?") {
      state().setPower(value == "1", Time::clock::now());
      return "OK";
    }
    switch (state().power) {
      case Power::kOff:
        return "0";
      case Power::kOn:
        return "1";
      case Power::kCooling:
        return "2";
      case Power::kWarming:
        return "3";
    }
    return "ERR4";
  }

  std::string get(char itsClass, const std::string& body) {
    const bool second = itsClass == '2';
    if (body == "CLSS") return std::to_string(options_.pjlinkClass);
    if (body == "NAME") return "Projector";
    if (body == "INF1") return "PixelFlex";
    if (body == "INF2") return "Simulator";
    if (body == "INFO") return "";
    if (body == "INST") return second ? "11 21 31 32 51" : "11 21 31 32";
    if (body == "ERST") return "000000";
    if (body == "LAMP") return std::to_string(state().hours) + (state().isOn() ? " 1" : " 0");
    if (second && body == "FILT") return "88";
    if (!state().isOn()) return "ERR3";
    if (body == "INPT") return std::to_string(state().input);
    if (body == "AVMT") return state().mute ? "11" : "30";
    if (second && body == "FREZ") return state().freeze ? "1" : "0";
    if (second && body == "IRES") return "1024x768";
    return "ERR1";
  }

  std::string set(char itsClass, const std::string& body, const std::string& value) {
    const bool switches = value == "0" || value == "1";
    if (body == "INPT") {
      const std::vector<std::string> inputs = {"11", "21", "31", "32", "51"};
      if (std::ranges::find(inputs, value) == inputs.end()) return "ERR2";
      state().input = std::stoi(value);
    } else if (body == "AVMT") {
      const std::array known = {"10", "11", "20", "21", "30", "31"};
      if (std::ranges::find(known, value) == known.end()) return "ERR2";
      if (value[0] != '2') state().mute = value[1] == '1';
    } else if (body == "FREZ" && itsClass == '2') {
      if (!switches) return "ERR2";
      state().freeze = value == "1";
    } else {
      return "ERR1";
    }
    return "OK";
  }

  PjlinkSimulatorOptions options_;
  std::string typed_;
  std::string random_;
  std::string random256_;
  bool let_ = false;
};

}  // namespace

std::unique_ptr<ProjectorSimulator> makePjlinkSimulator(const PjlinkSimulatorOptions& options) {
  return std::make_unique<PjlinkSimulator>(options);
}

}  // namespace pixelflex::devices
