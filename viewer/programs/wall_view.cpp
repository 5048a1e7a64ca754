#include "viewer/programs/wall_view.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "viewer/plan/overview.h"
#include "viewer/plan/wall_screens.h"
#include "viewer/programs/view_security.h"
#include "viewer/renderer/dither_tile.h"
#include "viewer/vnc/session.h"
#include "viewer/x11/local_session.h"
#include "viewer/x11/same_desktop.h"

namespace pixelflex::viewer {
namespace {

// Of --show-damage; a border is there for half a second.
constexpr std::chrono::milliseconds kFadeStep{100};

Retry retryOf(const ViewOptions& options) {
  return options.retry.value_or(options.screenshot ? Retry::kNever : Retry::kLost);
}

SessionOptions sessionOptions(const ViewOptions& options) {
  return {.server = options.server,
          .password = options.password,
          .user = options.user,
          .security = options.security,
          .viewOnly = options.viewOnly,
          .mayResize = options.resize != Resize::kNo,
          .clipboardLimit = options.clipboardLimit,
          .lossless = options.lossless,
          .link = options.link,
          .retry = retryOf(options)};
}

// The X display to show instead of what was asked for: only a VNC server may be passed by, and no wish for what it
// alone has.
std::optional<XDisplay> displayInstead(const ViewOptions& options) {
  const SecurityOptions& security = options.security;
  const bool secured =
      security.require != SecurityLevel::kNone || !security.caFile.empty() || !security.fingerprint.empty();
  // Who gives a password means it to be asked for; screens can be arranged over VNC alone.
  const bool identified = options.password || !options.user.empty();
  const bool arranged = options.resize == Resize::kScreenPerProjector;
  if (options.source != Source::kAuto || secured || identified || arranged) return std::nullopt;
  return displayBehind(options.server);
}

}  // namespace

ExpectedPlans expectPlans(const WallPlan& wall) {
  return std::async(std::launch::async, [&wall] {
    auto plans = wall.outputsFor(wall.desktop());
    (void)makeDitherTile();  // takes a while the first time
    return plans;
  });
}

WallView::WallView(const ViewOptions& options, const WallPlan& wall, ExpectedPlans expected,
                   devices::GlContext& context, const std::function<void()>& wake)
    : options_(options),
      wall_(wall),
      expected_(std::move(expected)),
      uploads_(measureUploads(context)),
      renderer_(context, {.bitsPerColour = options.depth, .upload = fastestUpload(uploads_)}),
      picture_(renderer_, options.whenLost),
      belt_(wake, renderer_.uploadMemory()),
      wake_(wake),
      source_(openSource()),
      reloader_({"pixelflex-view", options.wall, options.projectors, options.fit}, wall, wake) {
  renderer_.showDamage(options.showDamage);
  // What a screenshot shows is the desktop, as a screenshot taken on the server does.
  if (options.screenshot) renderer_.showCursor(false);
}

std::unique_ptr<DesktopSource> WallView::openSource() {
  LocalSessionOptions local{.viewOnly = options_.viewOnly,
                            .clipboardLimit = options_.clipboardLimit,
                            .primary = options_.primary,
                            .retry = retryOf(options_)};
  if (options_.server.isXDisplay()) {
    local.display = parseXDisplay(options_.server.xDisplay);
  } else if (const auto display = displayInstead(options_)) {
    fmt::print(stderr, "pixelflex-view: {} is the X display {} of this machine: shown directly\n",
               options_.server.text(), display->text());
    local.display = *display;
    direct_ = true;
  } else {
    return std::make_unique<Session>(sessionOptions(options_), belt_, wake_);
  }
  local_ = true;
  return std::make_unique<LocalSession>(local, belt_, wake_);
}

WallView::Step WallView::step() {
  if (Clock::now() >= ringUntil_) {
    ringUntil_ = Clock::time_point::max();
    picture_.unring();
  }
  for (const auto& event : source_->takeEvents()) handle(event);
  for (auto& [text, selection] : texts_.takeForDesktop()) source_->sendClipboard(std::move(text), selection);
  while (Batch* batch = belt_.take()) {
    if (batch->desktop != desktop_) adopt(batch->desktop);
    const auto begin = Clock::now();
    renderer_.upload(*batch);
    stages_.uploaded(*batch, begin, Clock::now());
    updateOpen_ = !batch->completesUpdate;
    if (batch->completesUpdate) {
      ++updates_;
      hasPicture_ = true;
      if (lostSince_ && connected_) comeBack();
    }
    belt_.release(batch);
  }
  if (!updateOpen_) adoptNewWall();
  Step step;
  step.plansChanged = std::exchange(plansChanged_, false);
  step.bell = std::exchange(bell_, false);
  step.copied = texts_.takeFromDesktop();
  const auto begin = Clock::now();
  if (renderer_.fading() && begin >= fadeDue_) renderer_.fadeDamage();
  step.drawn = renderer_.draw();
  if (!updateOpen_) stages_.drawn(begin, Clock::now());
  if (renderer_.fading() && begin >= fadeDue_) fadeDue_ = begin + kFadeStep;
  if (!step.drawn.empty()) lastChange_ = Clock::now();
  return step;
}

WallView::Clock::time_point WallView::due() const {
  return renderer_.fading() ? std::min(ringUntil_, fadeDue_) : ringUntil_;
}

void WallView::handle(const SessionEvent& event) {
  if (const auto* connected = std::get_if<Connected>(&event)) {
    desktopName_ = connected->name;
    connected_ = true;
    if (!hasPicture_) pointer_ = {connected->size.width / 2, connected->size.height / 2};
    texts_.sendAgain();
    // What is shown stays until there is a picture to replace it.
    if (!hasPicture_) adopt(connected->size);
    requestLayout();
    const std::string notice = securityNotice(options_, connected->security);
    const bool said = hasPicture_ && connected->security.newFingerprint.empty();
    if (!notice.empty() && !said) fmt::print(stderr, "pixelflex-view: {}\n", notice);
  } else if (const auto* shape = std::get_if<CursorShape>(&event)) {
    devices::Image8 image;
    if (shape->size.area() > 0) {
      image = devices::Image8(shape->size, 4);
      std::ranges::copy(shape->rgba, image.samples().begin());
    }
    picture_.setCursor(std::move(image), {shape->hotX, shape->hotY});
  } else if (const auto* refused = std::get_if<ResizeRefused>(&event)) {
    fmt::print(stderr, "pixelflex-view: {}; it is shown scaled\n", refused->message);
  } else if (const auto* link = std::get_if<LinkChanged>(&event)) {
    fmt::print(stderr, "pixelflex-view: {}\n", link->message);
  } else if (const auto* moved = std::get_if<CursorMoved>(&event)) {
    pointer_ = {moved->x, moved->y};
    picture_.moveCursor(pointer_);
  } else if (const auto* text = std::get_if<Clipboard>(&event)) {
    texts_.copyThere(*text, !local_);
  } else if (const auto* tooLong = std::get_if<ClipboardRefused>(&event)) {
    refuse(*tooLong);
  } else if (std::holds_alternative<Bell>(event)) {
    bell_ = true;
  } else if (const auto* lost = std::get_if<Lost>(&event)) {
    lose(lost->message);
  } else if (const auto* closed = std::get_if<Closed>(&event)) {
    if (direct_ && !hasPicture_) return goByVnc(retryOf(options_));
    if (closed->kind == CloseKind::kPasswordNeeded) throw PasswordNeeded(closed->message);
    throw ViewError(closed->message);
  }
}

void WallView::lose(const std::string& reason) {
  connected_ = false;
  // Whether its display will be the same when it returns, nobody knows.
  if (direct_) goByVnc(Retry::kAlways);
  if (lostSince_) return;
  lostSince_ = Clock::now();
  fmt::print(stderr, "pixelflex-view: {}; waiting for it to return\n", reason);
  picture_.lose(desktop_);
}

void WallView::goByVnc(Retry retry) {
  direct_ = local_ = false;
  connected_ = false;
  SessionOptions options = sessionOptions(options_);
  options.retry = retry;
  source_.reset();  // first, as the belt has one source at a time
  source_ = std::make_unique<Session>(std::move(options), belt_, wake_);
}

void WallView::comeBack() {
  const auto away = std::chrono::duration<double>(Clock::now() - *std::exchange(lostSince_, std::nullopt));
  fmt::print(stderr, "pixelflex-view: the desktop is there after {:.1f} s\n", away.count());
  picture_.comeBack();
}

void WallView::adopt(devices::Size desktop) {
  if (desktop == desktop_) return;
  desktop_ = desktop;
  reloader_.setDesktop(desktop);
  ExpectedPlans expected = std::exchange(expected_, {});
  const bool asExpected = expected.valid() && desktop == wall_.desktop() && !reloaded_;
  show(asExpected ? expected.get() : wall().outputsFor(desktop));
  ::malloc_trim(0);  // meshes and maps are on the GPU now, and what making them took would stay for as long as we run
}

void WallView::show(std::vector<OutputPlan> plans) {
  if (options_.control) plans.push_back(overviewOf(desktop_));
  renderer_.setPlans(plans);
  pointerMap_.emplace(wall(), desktop_);
  plansChanged_ = true;
}

// The desktop's pixels stay, so the next frame shows it whole.
void WallView::adoptNewWall() {
  auto fresh = reloader_.take();
  if (!fresh) return;
  reloaded_ = std::move(fresh->wall);
  fmt::print(stderr, "pixelflex-view: a new calibration is shown\n");
  if (desktop_.area() > 0) show(fresh->desktop == desktop_ ? fresh->plans : wall().outputsFor(desktop_));
  if (connected_) requestLayout();
}

void WallView::requestLayout() {
  if (options_.resize == Resize::kNo) return;
  ScreenLayout layout{wall().desktop(), {boxOf(wall().desktop())}};
  if (options_.resize == Resize::kScreenPerProjector) layout.screens = screensOfProjectors(wall());
  const bool fits = desktop_ == layout.desktop;
  if (source_->requestLayout(std::move(layout)) || fits) return;
  if (direct_) {
    goByVnc(retryOf(options_));
  } else {
    fmt::print(stderr, "pixelflex-view: this desktop cannot be asked for another size; it is shown scaled\n");
  }
}

void WallView::findPointer() {
  picture_.ring(desktop_);
  ringUntil_ = Clock::now() + std::chrono::seconds(1);
}

void WallView::copy(Selection selection, std::string text) {
  texts_.copyHere({std::move(text), selection});
  wake_();
}

void WallView::refuse(const ClipboardRefused& refused) {
  if (!texts_.isNew(refused)) return;
  fmt::print(stderr, "pixelflex-view: a text of more than {} bytes was copied {} and stays there{}\n", refused.limit,
             refused.onDesktop ? "on the desktop" : "here",
             refused.limit == options_.clipboardLimit ? "; see --clipboard-limit" : "");
}

void WallView::point(glm::ivec2 pointInDesktop, std::uint16_t buttons) {
  pointer_ = pointInDesktop;
  picture_.moveCursor(pointInDesktop);
  source_->sendPointer(pointInDesktop.x, pointInDesktop.y, buttons);
}

}  // namespace pixelflex::viewer
