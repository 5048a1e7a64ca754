#pragma once

#include <string>
#include <string_view>

#include "viewer/remote/wall_remote.h"

namespace pixelflex::viewer {

/// What a wall says about itself over PJLink. Longer texts than the protocol carries are cut.
struct PjlinkIdentity {
  std::string name;
  std::string serial;
  std::string version;
};

/// A whole wall as one PJLink device of class 2. Its inputs are 51, the desktop on the wall as it is, and its presets
/// in the order of the alphabet: 41 to 49, and 4A to 4Z for those who speak class 2. One thread uses it.
class PjlinkWall {
 public:
  /// `remote` must outlive it.
  PjlinkWall(WallRemote& remote, PjlinkIdentity identity) : remote_(remote), identity_(std::move(identity)) {}

  /// The parameter of the answer to "%<class><body> <value>", such as "OK", "1" or "ERR3". Any bytes may come.
  [[nodiscard]] std::string answer(char itsClass, std::string_view body, std::string_view value);

 private:
  [[nodiscard]] std::string obey(char itsClass, std::string_view name, std::string_view value);
  [[nodiscard]] std::string get(char itsClass, std::string_view body) const;
  [[nodiscard]] std::string getOfClass2(std::string_view body) const;
  [[nodiscard]] std::string set(char itsClass, std::string_view body, std::string_view value);
  [[nodiscard]] std::string setMute(std::string_view value);
  [[nodiscard]] std::string setInput(char itsClass, std::string_view code);
  [[nodiscard]] std::string power() const;
  [[nodiscard]] std::string errors() const;
  [[nodiscard]] std::string input() const;
  [[nodiscard]] std::string inputName(std::string_view code) const;
  [[nodiscard]] std::string resolution() const;
  [[nodiscard]] bool isStandingBy() const;

  WallRemote& remote_;
  PjlinkIdentity identity_;
  char muteForm_ = '1';  // as it was last ordered: the picture, or picture and sound
};

}  // namespace pixelflex::viewer
