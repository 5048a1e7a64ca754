#include "viewer/programs/wall_view.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <utility>

namespace pixelflex::viewer {
namespace {

std::optional<std::string> readPassword(const ViewOptions& options) {
  if (!options.passwordFile) return std::nullopt;
  const std::string& file = *options.passwordFile;
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) throw ViewError(file + ": no such password file");
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw ViewError(file + ": others can read this password file; run chmod 600 " + file);
  }
  std::ifstream stream(file);
  std::string password;
  if (!std::getline(stream, password)) throw ViewError(file + ": holds no password (its first line is taken)");
  return password;
}

SessionOptions sessionOptions(const ViewOptions& options) {
  return {.server = options.server, .password = readPassword(options), .viewOnly = options.viewOnly};
}

}  // namespace

WallView::WallView(const ViewOptions& options, const WallPlan& wall, devices::GlContext& context,
                   const std::function<void()>& wake)
    : wall_(wall),
      renderer_(context, {.bitsPerColour = options.depth}),
      belt_(wake),
      session_(sessionOptions(options), belt_, wake) {
  // What a screenshot shows is the desktop, as a screenshot taken on the server does.
  if (options.screenshot) renderer_.showCursor(false);
}

WallView::Step WallView::step() {
  for (const auto& event : session_.takeEvents()) handle(event);
  while (Batch* batch = belt_.take()) {
    if (batch->desktop != desktop_) adopt(batch->desktop);
    renderer_.upload(*batch);
    if (batch->completesUpdate) {
      ++updates_;
      hasPicture_ = true;
    }
    belt_.release(batch);
  }
  Step step;
  step.plansChanged = std::exchange(plansChanged_, false);
  step.drawn = renderer_.draw();
  if (!step.drawn.empty()) lastChange_ = Clock::now();
  return step;
}

void WallView::handle(const SessionEvent& event) {
  if (const auto* connected = std::get_if<Connected>(&event)) {
    desktopName_ = connected->name;
    adopt(connected->size);
  } else if (const auto* shape = std::get_if<CursorShape>(&event)) {
    devices::Image8 image;
    if (shape->size.area() > 0) {
      image = devices::Image8(shape->size, 4);
      std::ranges::copy(shape->rgba, image.samples().begin());
    }
    renderer_.setCursor(image, {shape->hotX, shape->hotY});
  } else if (const auto* moved = std::get_if<CursorMoved>(&event)) {
    renderer_.moveCursor({moved->x, moved->y});
  } else if (const auto* closed = std::get_if<Closed>(&event)) {
    throw ViewError(closed->message);
  }
}

void WallView::adopt(devices::Size desktop) {
  if (desktop == desktop_) return;
  desktop_ = desktop;
  renderer_.setPlans(wall_.outputsFor(desktop));
  pointerMap_.emplace(wall_, desktop);
  plansChanged_ = true;
}

void WallView::point(glm::ivec2 pointInDesktop, std::uint8_t buttons) {
  renderer_.moveCursor(pointInDesktop);
  session_.sendPointer(pointInDesktop.x, pointInDesktop.y, buttons);
}

}  // namespace pixelflex::viewer
