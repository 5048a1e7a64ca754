#include "viewer/programs/stats_printer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "viewer/renderer/text_panel.h"

namespace pixelflex::viewer {
namespace {

constexpr std::chrono::seconds kWorkPeriod{1};
constexpr std::chrono::seconds kStagesPeriod{10};

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

RenderStats difference(RenderStats now, const RenderStats& before) {
  now.bytesUploaded -= before.bytesUploaded;
  now.outputsDrawn -= before.outputsDrawn;
  now.pixelsDrawn -= before.pixelsDrawn;
  now.uploadTime -= before.uploadTime;
  now.drawTime -= before.drawTime;
  return now;
}

}  // namespace

StatsPrinter::StatsPrinter(const ViewOptions& options)
    : prints_(options.stats), overlays_(options.statsOverlay), of_(options.statsOf), started_(options.started) {
  second_.due = begun_ + kWorkPeriod;
  tenSeconds_.due = begun_ + kStagesPeriod;
  if (!options.statsJson) return;
  // A line is written at once, so that those of several processes do not mix.
  json_.emplace(*options.statsJson, of_.empty() ? std::ios::out : std::ios::app);
  if (!*json_) throw ViewError("cannot write to " + *options.statsJson + ": give --stats-json another file");
}

WallView::Clock::time_point StatsPrinter::due() const {
  const Time second = prints_ || overlays_ ? second_.due : Time::max();
  const Time tenSeconds = prints_ || json_ ? tenSeconds_.due : Time::max();
  return std::min(second, tenSeconds);
}

Account StatsPrinter::since(const Mark& mark, WallView& view, Time now) const {
  return {.seconds = std::chrono::duration<double>(now - begun_).count(),
          .updates = view.updates() - mark.updates,
          .render = difference(view.renderer().stats(), mark.render),
          .stages = view.stages().summaryOfLast(view.stages().count() - mark.shown)};
}

StatsPrinter::Mark StatsPrinter::markOf(WallView& view, Time due) {
  return {due, view.renderer().stats(), view.updates(), view.stages().count()};
}

void StatsPrinter::printIfDue(WallView& view) {
  const Time now = WallView::Clock::now();
  if ((prints_ || overlays_) && now >= second_.due) {
    const Account account = since(second_, view, now);
    if (prints_) printWork(account);
    if (overlays_ && account.stages.updates > 0) showPanel(account, view);
    second_ = markOf(view, now + kWorkPeriod);
  }
  if ((prints_ || json_) && now >= tenSeconds_.due) {
    printStages(since(tenSeconds_, view, now));
    tenSeconds_ = markOf(view, now + kStagesPeriod);
  }
}

void StatsPrinter::shown(const WallView& view) {
  if (firstShown_ || !view.hasPicture()) return;
  firstShown_ = true;
  const double seconds = std::chrono::duration<double>(WallView::Clock::now() - started_).count();
  const std::string uploads = describeUploads(view.uploads());
  if (prints_) {
    const std::string head = headOf("stats", of_);
    fmt::print(stderr, "{} the first picture {:.3f} s after the start\n{} uploads from {}\n", head, seconds, head,
               uploads);
  }
  if (json_) {
    *json_ << fmt::format(R"({{{}"first_picture_s":{:.3f},"uploads":"{}"}})", jsonHeadOf(of_), seconds, uploads)
           << std::endl;
  }
}

void StatsPrinter::printWork(const Account& account) const {
  const RenderStats& done = account.render;
  if (done.bytesUploaded == 0 && done.outputsDrawn == 0) return;
  fmt::print(stderr,
             "{} {:7.1f} s  updates {:4}  uploaded {:9.3f} MB  outputs drawn {:4}  pixels {:9.3f} M  "
             "upload {:6.1f} ms  draw {:6.1f} ms\n",
             headOf("stats", of_), account.seconds, account.updates, static_cast<double>(done.bytesUploaded) / 1e6,
             done.outputsDrawn, static_cast<double>(done.pixelsDrawn) / 1e6, milliseconds(done.uploadTime),
             milliseconds(done.drawTime));
}

void StatsPrinter::showPanel(const Account& account, WallView& view) {
  WallRenderer& renderer = view.renderer();
  if (renderer.outputCount() == 0) return;
  constexpr int kWidthPerScale = 800;  // of projectors whose pixels are about as large
  const int scale = std::max(1, renderer.outputResolution(0).width / kWidthPerScale);
  renderer.setPanel(0, textPanel(panelText(account), scale));
}

void StatsPrinter::toggleOverlay(WallView& view) {
  overlays_ = !overlays_;
  const Time now = WallView::Clock::now();
  if (overlays_) {
    showPanel(since({}, view, now), view);
    second_ = markOf(view, now + kWorkPeriod);
  } else {
    view.renderer().setPanel(0, {});
  }
}

void StatsPrinter::printStages(const Account& account) {
  if (account.stages.updates == 0) return;
  if (prints_) {
    fmt::print(stderr, "{} {:.1f} s  updates {}  median/p99/max ms: {}\n", headOf("latency", of_), account.seconds,
               account.stages.updates, stagesText(account.stages));
  }
  if (json_) *json_ << jsonOf(account, of_) << std::endl;
}

void StatsPrinter::printTotal(WallView& view) {
  Account total = since({}, view, WallView::Clock::now());
  total.total = true;
  if (prints_) {
    fmt::print(stderr, "{} total updates {} uploaded {} bytes outputs drawn {} pixels {}\n", headOf("stats", of_),
               total.updates, total.render.bytesUploaded, total.render.outputsDrawn, total.render.pixelsDrawn);
  }
  if (prints_ || json_) printStages(total);
}

}  // namespace pixelflex::viewer
