#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace pixelflex::viewer {

/// One connection of a PJLink server: its greeting, who may come in, commands and answers. Knows no network.
class PjlinkSession {
 public:
  /// The parameter of the answer to a command: its class, its four letters, its parameter.
  using Obey = std::function<std::string(char itsClass, std::string_view body, std::string_view value)>;

  /// So many hexadecimal digits that nobody can foresee.
  using Random = std::function<std::string(std::size_t digits)>;
  [[nodiscard]] static std::string freshRandom(std::size_t digits);

  /// An empty password lets everybody in.
  PjlinkSession(std::string password, Obey obey, Random random = freshRandom);

  /// What to say first.
  [[nodiscard]] std::string greeting() const;
  /// What to say to any bytes; several commands at once are answered one after the other.
  [[nodiscard]] std::string receive(std::string_view bytes);
  /// Everything is said: a wrong password, or no PJLink at all.
  [[nodiscard]] bool wantsClose() const { return refused_ || closes_; }
  /// The password was wrong.
  [[nodiscard]] bool isRefused() const { return refused_; }

 private:
  [[nodiscard]] std::string hear(std::string line);
  /// Takes the digest off the front of the first command.
  [[nodiscard]] bool letIn(std::string& line);

  std::string password_;
  Obey obey_;
  Random makeRandom_;
  std::string random_;     // of MD5, eight digits
  std::string random256_;  // of SHA-256, 32; empty: not asked for
  std::string typed_;
  bool isIn_ = false;
  bool refused_ = false;
  bool closes_ = false;
};

}  // namespace pixelflex::viewer
