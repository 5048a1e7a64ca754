#include "viewer/programs/stats_printer.h"

#include <fmt/format.h>

#include <cstdio>

namespace pixelflex::viewer {
namespace {

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace

WallView::Clock::time_point StatsPrinter::due() const {
  return enabled_ ? due_ : WallView::Clock::time_point::max();
}

void StatsPrinter::printIfDue(WallView& view) {
  const auto now = WallView::Clock::now();
  if (!enabled_ || now < due_) return;
  due_ = now + kPeriod;
  const RenderStats stats = view.renderer().stats();
  if (stats.bytesUploaded == before_.bytesUploaded && stats.outputsDrawn == before_.outputsDrawn) return;
  fmt::print(stderr,
             "stats: {:7.1f} s  updates {:4}  uploaded {:9.3f} MB  outputs drawn {:4}  pixels {:9.3f} M  "
             "upload {:6.1f} ms  draw {:6.1f} ms\n",
             std::chrono::duration<double>(now - begun_).count(), view.updates() - updatesBefore_,
             static_cast<double>(stats.bytesUploaded - before_.bytesUploaded) / 1e6,
             stats.outputsDrawn - before_.outputsDrawn,
             static_cast<double>(stats.pixelsDrawn - before_.pixelsDrawn) / 1e6,
             milliseconds(stats.uploadTime - before_.uploadTime), milliseconds(stats.drawTime - before_.drawTime));
  before_ = stats;
  updatesBefore_ = view.updates();
}

void StatsPrinter::printTotal(WallView& view) const {
  if (!enabled_) return;
  const RenderStats stats = view.renderer().stats();
  fmt::print(stderr, "stats: total updates {} uploaded {} bytes outputs drawn {} pixels {}\n", view.updates(),
             stats.bytesUploaded, stats.outputsDrawn, stats.pixelsDrawn);
}

}  // namespace pixelflex::viewer
