#include "viewer/programs/view_command.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <map>
#include <stdexcept>

#include "calib/programs/command_line.h"
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

void checkFingerprint(const std::string& text) {
  if (text.empty() || normalFingerprint(text)) return;
  throw std::invalid_argument("--tls-fingerprint " + text + ": a SHA-256 has 64 hexadecimal digits");
}

void addPicture(CLI::App& app, ViewOptions& options, ViewTexts& texts) {
  app.add_option("WALL", options.wall, "the wall's folder")->required();
  app.add_option("SERVER", texts.server, "the VNC server, or the X server of this machine")->required();
  app.add_flag("--headless", options.headless, "draw without any window or X server (EGL)");
  app.add_option("--screenshot", options.screenshot,
                 "once the picture is complete and still, write DIR/<projector>.png and DIR/desktop.png and exit");
  app.add_option("--settle", texts.settle, "how many milliseconds nothing must change before the screenshot")
      ->check(CLI::Range(0, 3'600'000))
      ->capture_default_str();
  app.add_option("--projectors", options.projectors, "only these projectors")->delimiter(',');
  calib::takeOneOf(
      app.add_option(
             "--fit", options.fit.fit,
             "a desktop of another size than the wall's: letterbox keeps its aspect, stretch fills the wall; else "
             "letterbox")
          ->option_text("letterbox|stretch"),
      kFits);
  app.add_option("--region", texts.region, "show only this part of the desktop: X,Y,WIDTHxHEIGHT, desktop pixels");
  calib::takeOneOf(app.add_option("--source", options.source,
                                  "auto: straight from the X server of this machine when the VNC server is Xvnc, thus "
                                  "one and the same, it lets "
                                  "us in and nothing is wished for that only VNC has; else vnc, as SERVER says")
                       ->option_text("auto|vnc"),
                   kSources);
  app.add_flag("--resize", texts.resize,
               "ask the server for a desktop of the wall's own size, and again after a new calibration");
  app.add_option("--screens", texts.screens,
                 "with --resize: one screen for the wall, or one for each of its projectors")
      ->check(CLI::IsMember({"one", "projectors"}))
      ->capture_default_str();
}

void addInput(CLI::App& app, ViewOptions& options, ViewTexts& texts) {
  app.add_flag("--view-only", options.viewOnly, "send neither pointer nor keys nor clipboard");
  calib::takeOneOf(
      app.add_option(
             "--pointer", options.pointer,
             "desktop: the mouse moves over the desktop wherever the windows are, Ctrl+Alt+G lets it go; screen: over "
             "the windows as they lie; auto: screen where they lie as on the wall. Ctrl twice, or shaking it, shows "
             "where "
             "it is")
          ->option_text("auto|desktop|screen"),
      kPointerModes);
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
  app.add_option("--primary", texts.primary,
                 "whether what is marked with the mouse, for its middle button, goes both ways like what is copied; a "
                 "VNC desktop has one clipboard for both")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
}

void addConnection(CLI::App& app, ViewOptions& options, ViewTexts& texts) {
  app.add_option("--password-file", options.passwordFile,
                 "the first line is the password, or vncpasswd wrote it; mode 0600. Without it PIXELFLEX_VNC_PASSWORD "
                 "is taken, or the terminal is asked");
  app.add_option("--user", options.user, "for servers that ask who it is; otherwise PIXELFLEX_VNC_USER is taken");
  app.add_option(
         "--require", texts.require,
         "refuse a connection below: none, vnc (a password), tls (encrypted), x509 (encrypted, the server known)")
      ->check(CLI::IsMember({"none", "vnc", "tls", "x509"}))
      ->capture_default_str();
  app.add_option("--tls-ca", options.security.caFile, "PEM file with the only authorities to trust");
  app.add_option("--tls-fingerprint", options.security.fingerprint, "SHA-256 of the only certificate to trust");
  calib::takeOneOf(
      app.add_option(
             "--link", options.link,
             "what to spend on the way to the server: local (every pixel as it is), lan, wifi or wan (JPEG, ever more "
             "compressed); auto: local within this machine, else as measured")
          ->option_text("auto|local|lan|wifi|wan"),
      kLinks);
  app.add_flag("--lossless", options.lossless, "no JPEG over any link: every pixel arrives as it is");
}

void addRest(CLI::App& app, ViewOptions& options, ViewTexts& texts) {
  app.add_option("--depth", options.depth,
                 "bits for each colour that the projectors are sent, 8 or 10; with 10 their screenshots are 16-bit PNG")
      ->check(CLI::IsMember({8, 10}))
      ->capture_default_str();
  calib::takeOneOf(
      app.add_option(
             "--retry", options.retry,
             "whether to wait for a server that is gone: lost, once it was there; always, also at the start; never. "
             "never is usual with --screenshot, else lost")
          ->option_text("lost|always|never"),
      kRetries);
  calib::takeOneOf(
      app.add_option("--when-lost", options.whenLost,
                     "the last picture of a server that is gone: dim, mark (with a sign) or keep as it is; else dim")
          ->option_text("dim|mark|keep"),
      kWhenLost);
  app.add_flag("--stats{log}", texts.stats,
               "print when the first picture is there, what was uploaded and drawn each second, and each ten how long "
               "every stage "
               "took; "
               "--stats=overlay: shown on the first projector instead, as Ctrl+Alt+S does at any time")
      ->check(CLI::IsMember({"log", "overlay"}));
  app.add_option("--stats-json", options.statsJson,
                 "write the same to FILE, a JSON object a line; with several X displays each line names its own")
      ->option_text("FILE");
  app.add_flag("--show-damage", options.showDamage, "show what is drawn again by borders that fade");
}

}  // namespace

void defineOptions(CLI::App& app, ViewOptions& options, ViewTexts& texts) {
  texts.settle = static_cast<int>(options.settle.count());
  texts.require = nameOf(options.security.require);
  addPicture(app, options, texts);
  addInput(app, options, texts);
  addConnection(app, options, texts);
  addRest(app, options, texts);
  app.footer(
      "In its windows, on whatever layout of the keyboard: Ctrl+Alt+Q ends it, Ctrl+Alt+S shows how long updates take "
      "on the first projector, Ctrl+Alt+G lets pointer and keyboard go, Ctrl twice shows where the pointer is.\n"
      "Where projectors are on several X displays, each display has a process of its own, which is started again when "
      "it fails; all write their statistics, the control window and the wish for another size are the first one's.");
}

void take(const ViewTexts& texts, ViewOptions& options) {
  options.settle = std::chrono::milliseconds(texts.settle);
  options.stats = texts.stats == "log";
  options.statsOverlay = texts.stats == "overlay";
  if (!texts.region.empty()) options.fit.region = parseRegion(texts.region);
  options.primary = texts.primary == "on";
  if (texts.resize) options.resize = texts.screens == "one" ? Resize::kOneScreen : Resize::kScreenPerProjector;
  options.server = parseServerAddress(texts.server);
  if (options.server.isXDisplay()) (void)parseXDisplay(options.server.xDisplay);
  options.security.require = parseSecurityLevel(texts.require);
  checkFingerprint(options.security.fingerprint);
}

}  // namespace pixelflex::viewer
