// pixelflex view WALL SERVER: a desktop on the wall, a VNC server's or an X server's.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include "calib/store/store.h"
#include "viewer/programs/display_viewers.h"
#include "viewer/programs/headless.h"
#include "viewer/programs/password.h"
#include "viewer/programs/view_options.h"
#include "viewer/programs/view_security.h"
#include "viewer/programs/wall_view.h"
#include "viewer/programs/windows.h"
#include "viewer/vnc/known_servers.h"
#include "viewer/x11/x_display.h"

namespace pixelflex::viewer {
namespace {

const std::map<std::string, Retry> kRetries{
    {"never", Retry::kNever}, {"lost", Retry::kLost}, {"always", Retry::kAlways}};
const std::map<std::string, PointerMode> kPointerModes{
    {"auto", PointerMode::kAuto}, {"desktop", PointerMode::kDesktop}, {"screen", PointerMode::kScreen}};
const std::map<std::string, WhenLost> kWhenLost{
    {"dim", WhenLost::kDim}, {"mark", WhenLost::kMark}, {"keep", WhenLost::kKeep}};

const std::map<std::string, Fit> kFits{{"letterbox", Fit::kLetterbox}, {"stretch", Fit::kStretch}};

const std::map<std::string, Link> kLinks{
    {"auto", Link::kAuto}, {"local", Link::kLocal}, {"lan", Link::kLan}, {"wifi", Link::kWifi}, {"wan", Link::kWan}};

const std::map<std::string, Source> kSources{{"vnc", Source::kVnc}, {"auto", Source::kAuto}};

int view(const ViewOptions& options) {
  const WallPlan wall(options.wall, calib::loadWall(options.wall), calib::loadCalibration(options.wall),
                      options.projectors, options.fit);
  if (options.headless) return runHeadless(options, wall);
  const auto shares = sharesOfDisplays(wall);
  return shares.empty() ? runWindows(options, wall) : runViewers(options, shares, view);
}

// Asks for the password only when a server wants one that was not given.
int viewWithPassword(ViewOptions& options) {
  completeSecurity(options);
  try {
    return view(options);
  } catch (const PasswordNeeded& needed) {
    if (options.password) throw;
    options.password = askForPassword("Password for " + options.server.text() + ": ");
    if (!options.password) throw;
  }
  return view(options);
}

void checkFingerprint(const std::string& text) {
  if (text.empty() || normalFingerprint(text)) return;
  throw std::invalid_argument("--tls-fingerprint " + text + ": a SHA-256 has 64 hexadecimal digits");
}

/// Where libXau looks by itself; unless it is named, it writes that into a buffer that all threads share.
void nameXauthority() {
  const char* const home = std::getenv("HOME");
  if (home != nullptr) ::setenv("XAUTHORITY", (std::string(home) + "/.Xauthority").c_str(), 0);
}

}  // namespace
}  // namespace pixelflex::viewer

int main(int argc, char** argv) {
  pixelflex::viewer::nameXauthority();
  pixelflex::viewer::ViewOptions options;
  CLI::App app{
      "Shows a desktop on the wall. SERVER is a VNC server, HOST:DISPLAY, HOST::PORT, [V6]::PORT or unix:PATH, or an X "
      "server of this machine, x11:DISPLAY (x11::7).",
      "pixelflex-view"};
  app.set_version_flag("--version", PIXELFLEX_VERSION);
  app.footer(
      "In its windows, on whatever layout of the keyboard: Ctrl+Alt+Q ends it, Ctrl+Alt+S shows how long updates take "
      "on the first projector, Ctrl+Alt+G lets pointer and keyboard go, Ctrl twice shows where the pointer is.\n"
      "Where projectors are on several X displays, each display has a process of its own, which is started again when "
      "it fails; all write their statistics, the control window and the wish for another size are the first one's.");
  app.add_option("WALL", options.wall, "the wall's folder")->required();
  std::string server;
  app.add_option("SERVER", server, "the VNC server, or the X server of this machine")->required();
  app.add_flag("--headless", options.headless, "draw without any window or X server (EGL)");
  app.add_option("--screenshot", options.screenshot,
                 "once the picture is complete and still, write DIR/<projector>.png and DIR/desktop.png and exit");
  int settle = static_cast<int>(options.settle.count());
  app.add_option("--settle", settle, "how many milliseconds nothing must change before the screenshot")
      ->check(CLI::Range(0, 3'600'000))
      ->capture_default_str();
  app.add_option("--projectors", options.projectors, "only these projectors")->delimiter(',');
  app.add_option("--fit", options.fit.fit,
                 "a desktop of another size than the wall's: letterbox keeps its aspect, stretch fills the wall; else "
                 "letterbox")
      ->transform(CLI::CheckedTransformer(pixelflex::viewer::kFits))
      ->option_text("letterbox|stretch");
  std::string region;
  app.add_option("--region", region, "show only this part of the desktop: X,Y,WIDTHxHEIGHT, desktop pixels");
  app.add_option(
         "--source", options.source,
         "auto: straight from the X server of this machine when the VNC server is Xvnc, thus one and the same, it lets "
         "us in and nothing is wished for that only VNC has; else vnc, as SERVER says")
      ->transform(CLI::CheckedTransformer(pixelflex::viewer::kSources))
      ->option_text("auto|vnc");
  bool resize = false;
  app.add_flag("--resize", resize,
               "ask the server for a desktop of the wall's own size, and again after a new calibration");
  std::string screens = "one";
  app.add_option("--screens", screens, "with --resize: one screen for the wall, or one for each of its projectors")
      ->check(CLI::IsMember({"one", "projectors"}))
      ->capture_default_str();
  app.add_flag("--view-only", options.viewOnly, "send neither pointer nor keys nor clipboard");
  app.add_option(
         "--pointer", options.pointer,
         "desktop: the mouse moves over the desktop wherever the windows are, Ctrl+Alt+G lets it go; screen: over "
         "the windows as they lie; auto: screen where they lie as on the wall. Ctrl twice, or shaking it, shows where "
         "it is")
      ->transform(CLI::CheckedTransformer(pixelflex::viewer::kPointerModes))
      ->option_text("auto|desktop|screen");
  app.add_flag("--grab", options.grab,
               "all keys go to the desktop, the window manager's shortcuts too; Ctrl+Alt+G lets keyboard and pointer "
               "go and takes them, also without this")
      ->excludes("--headless");
  app.add_flag("--control", options.control, "a window with the whole desktop, to point and type without the wall")
      ->excludes("--headless")
      ->excludes("--screenshot");
  app.add_option("--clipboard-limit", options.clipboardLimit, "bytes of the longest text to copy; 0: no clipboard")
      ->check(CLI::Range(0, 256 << 20))
      ->capture_default_str();
  std::string primary = "on";
  app.add_option("--primary", primary,
                 "whether what is marked with the mouse, for its middle button, goes both ways like what is copied; a "
                 "VNC desktop has one clipboard for both")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  app.add_option("--password-file", options.passwordFile,
                 "the first line is the password, or vncpasswd wrote it; mode 0600. Without it PIXELFLEX_VNC_PASSWORD "
                 "is taken, or the terminal is asked");
  app.add_option("--user", options.user, "for servers that ask who it is; otherwise PIXELFLEX_VNC_USER is taken");
  std::string require = pixelflex::viewer::nameOf(options.security.require);
  app.add_option(
         "--require", require,
         "refuse a connection below: none, vnc (a password), tls (encrypted), x509 (encrypted, the server known)")
      ->check(CLI::IsMember({"none", "vnc", "tls", "x509"}))
      ->capture_default_str();
  app.add_option("--tls-ca", options.security.caFile, "PEM file with the only authorities to trust");
  app.add_option("--tls-fingerprint", options.security.fingerprint, "SHA-256 of the only certificate to trust");
  app.add_option(
         "--link", options.link,
         "what to spend on the way to the server: local (every pixel as it is), lan, wifi or wan (JPEG, ever more "
         "compressed); auto: local within this machine, else as measured")
      ->transform(CLI::CheckedTransformer(pixelflex::viewer::kLinks))
      ->option_text("auto|local|lan|wifi|wan");
  app.add_flag("--lossless", options.lossless, "no JPEG over any link: every pixel arrives as it is");
  app.add_option("--depth", options.depth,
                 "bits for each colour that the projectors are sent, 8 or 10; with 10 their screenshots are 16-bit PNG")
      ->check(CLI::IsMember({8, 10}))
      ->capture_default_str();
  app.add_option(
         "--retry", options.retry,
         "whether to wait for a server that is gone: lost, once it was there; always, also at the start; never. "
         "never is usual with --screenshot, else lost")
      ->transform(CLI::CheckedTransformer(pixelflex::viewer::kRetries))
      ->option_text("lost|always|never");
  app.add_option("--when-lost", options.whenLost,
                 "the last picture of a server that is gone: dim, mark (with a sign) or keep as it is; else dim")
      ->transform(CLI::CheckedTransformer(pixelflex::viewer::kWhenLost))
      ->option_text("dim|mark|keep");
  std::string stats;
  app.add_flag("--stats{log}", stats,
               "print when the first picture is there, what was uploaded and drawn each second, and each ten how long "
               "every stage "
               "took; "
               "--stats=overlay: shown on the first projector instead, as Ctrl+Alt+S does at any time")
      ->check(CLI::IsMember({"log", "overlay"}));
  app.add_option("--stats-json", options.statsJson,
                 "write the same to FILE, a JSON object a line; with several X displays each line names its own")
      ->option_text("FILE");
  app.add_flag("--show-damage", options.showDamage, "show what is drawn again by borders that fade");
  try {
    app.parse(argc, argv);
    options.settle = std::chrono::milliseconds(settle);
    options.stats = stats == "log";
    options.statsOverlay = stats == "overlay";
    if (!region.empty()) options.fit.region = pixelflex::viewer::parseRegion(region);
    options.primary = primary == "on";
    using pixelflex::viewer::Resize;
    if (resize) options.resize = screens == "one" ? Resize::kOneScreen : Resize::kScreenPerProjector;
    options.server = pixelflex::viewer::parseServerAddress(server);
    if (options.server.isXDisplay()) (void)pixelflex::viewer::parseXDisplay(options.server.xDisplay);
    options.security.require = pixelflex::viewer::parseSecurityLevel(require);
    pixelflex::viewer::checkFingerprint(options.security.fingerprint);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "pixelflex-view: {}\n", error.what());
    return 2;
  }
  try {
    return pixelflex::viewer::viewWithPassword(options);
  } catch (const std::exception& error) {
    std::fflush(stdout);
    fmt::print(stderr, "pixelflex-view: {}\n", error.what());
    return 1;
  }
}
