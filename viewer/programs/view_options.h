#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "viewer/plan/desktop_fit.h"
#include "viewer/vnc/session.h"

namespace pixelflex::viewer {

/// What a server is asked to make of its desktop.
enum class Resize { kNo, kOneScreen, kScreenPerProjector };

/// What the wall shows of a server that is gone: its last picture in any case.
enum class WhenLost { kDim, kMark, kKeep };

/// "X,Y,WxH", desktop pixels. Throws std::invalid_argument.
[[nodiscard]] Box parseRegion(const std::string& text);

/// How the desktop of a VNC server of this machine comes here.
enum class Source {
  kVnc,
  kAuto,  // straight from its X server, where that is certainly the same desktop
};

/// How the pointer goes over the wall: as the X pointer over the windows, or as the mouse over the desktop, wherever
/// the windows are. kAuto takes the first where the windows lie as on the wall.
enum class PointerMode { kAuto, kDesktop, kScreen };

/// The command line of `pixelflex view`.
struct ViewOptions {
  std::string wall;
  ServerAddress server;
  Source source = Source::kAuto;
  bool headless = false;
  std::optional<std::string> screenshot;  // folder
  std::chrono::milliseconds settle{500};
  std::vector<std::string> projectors;  // empty: all
  FitOptions fit;
  Resize resize = Resize::kNo;
  bool viewOnly = false;
  PointerMode pointer = PointerMode::kAuto;
  bool grab = false;                                  // all keys go to the desktop
  bool control = false;                               // a window with the whole desktop beside the wall
  std::size_t clipboardLimit = std::size_t{1} << 20;  // bytes; 0: no clipboard
  bool primary = true;                                // what is marked with the mouse goes both ways, too
  std::optional<std::string> passwordFile;
  std::optional<Secret> password;  // out of that file, the environment or a prompt
  std::string user;
  SecurityOptions security;
  Link link = Link::kAuto;
  bool lossless = false;
  std::optional<Retry> retry;  // empty: kNever for a screenshot, else kLost
  WhenLost whenLost = WhenLost::kDim;
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();  // of the program
  bool stats = false;
  bool statsOverlay = false;  // on the first projector
  bool showDamage = false;
  std::optional<std::string> statsJson;  // file
  std::string statsOf;                   // the display, where there are several: then the file is added to
  int depth = 8;                         // bits for each colour of a projector's picture: 8 or 10
};

}  // namespace pixelflex::viewer
