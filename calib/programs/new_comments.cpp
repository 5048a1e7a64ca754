#include <array>
#include <sstream>
#include <string>
#include <string_view>

#include "calib/programs/new_wall.h"
#include "calib/store/store.h"

namespace pixelflex::calib {
namespace {

/// Comment lines that go before the first line that begins with `key`.
struct Remark {
  std::string_view key;
  std::string_view text;
};

constexpr std::array kRemarks = {
    Remark{"# A PixelFlex wall",
           "# Edit this file to say what the wall consists of; pixelflex check says whether it is in order.\n"},
    Remark{"rig:", "\n# The optics of a simulated wall.\n"},
    Remark{
        "surface:",
        "\n# The screen. Wall coordinates have x to the right and y down, as the audience sees it, in these units.\n"},
    Remark{"  shape:",
           "  # planar; or camera (no model: the display space is the camera's undistorted image, in its pixels);\n"
           "  # or {cylinder: {radius: 3000}} with a vertical axis (the display space is the unrolled screen).\n"},
    Remark{
        "  fiducials:",
        "  # Four or more markers, six or more on a cylinder, and the measured place of each one's centre. `aruco` is\n"
        "  # an id of the printed dictionary DICT_4X4_50; instead of it `camera: [x, y]` gives a pixel of the "
        "photograph\n"
        "  # fiducials.png.\n"},
    Remark{"camera:",
           "\n# Where photographs of the wall come from: photos (files taken with any camera), v4l2:/dev/video0,\n"
           "# aravis:NAME, gphoto2:first, sim, or none (a wall that needs no camera). Optional: `transfer: linear` or "
           "`srgb` says how "
           "they\n"
           "# encode light; without it they count as linear unless gamma: camera measures it.\n"},
    Remark{"  checkerboard:", "  # Inner corners (columns, rows) and the side of a square in millimetres.\n"},
    Remark{"projectors:",
           "\n# Every projector or screen. `output` says where it is plugged in: {monitor: HDMI-1} by its name,\n"
           "# {display: \":0\", at: [1024, 0]} by display and position, sim, or none.\n"
           "# Optional: `gamma: readings/p1.csv`, 256 rows value,red,green,blue in any linear unit of light, or\n"
           "# `gamma: camera`, which measures them with the camera at several exposures; without it sRGB is assumed;\n"
           "# `control: {driver: pjlink, at: \"tcp://10.0.0.5:4352\"}` (hitachi-legacy, proxima-dp6850, hitachi-beef, "
           "pjlink,\n"
           "# escvp21, infocus; at tcp://, rfc2217:// or serial:/dev/ttyUSB0?baud=9600); `password_file: FILE` inside "
           "where "
           "one is asked;\n"
           "# `mirror: {driver: ptu, at: \"tcp://10.0.0.9:2101\"}`, a pan-tilt unit.\n"},
    Remark{"    flat:",
           "    # The screen's top-left pixel shows this desktop pixel, one to one; no camera is needed.\n"},
    Remark{
        "blend:",
        "\n# The exponent n of the blending weights: larger values favour the denser projector more.\n"
        "# `priority_feather: 60` lets much denser projectors (an inset) win, with a ramp of 60 of their pixels.\n"
        "# `stack: left-right` gives pairs that light the same part of the wall an eye each; else they share.\n"
        "# `uniformity` matches the projectors' light and colour, from 0 (brightest) to 1 (flattest), or off;\n"
        "# `black: even` lifts black to where the most projectors overlap, so that dark pictures show no overlaps, at\n"
        "# a cost in contrast that `calibrate` tells; `native` leaves it.\n"},
    Remark{"display:",
           "# The display area on the wall: `aspect` is any or W:H, `margin` the desktop pixels kept clear of the "
           "edge.\n"},
    Remark{
        "desktop:",
        "# The desktop's resolution: `density` is mean, max, or projector pixels per unit of the wall;\n"
        "# `oversampling` is projector pixels per desktop pixel (1.25 keeps small text crisp). `filter` is "
        "catmull-rom,\n"
        "# bilinear or nearest; `filter_domain` is srgb (strokes of text keep their weight) or linear (fine patterns\n"
        "# keep their brightness).\n"},
    Remark{"transfer:",
           "# How the desktop's pixels encode light: srgb, or linear (codes are proportional to light).\n"},
};

}  // namespace

std::string commentedWall(const Wall& wall) {
  std::array<bool, kRemarks.size()> used{};
  std::string text;
  std::istringstream lines(formatWall(wall));
  for (std::string line; std::getline(lines, line);) {
    std::string_view remark;
    for (std::size_t i = 0; i < kRemarks.size(); ++i) {
      if (used.at(i) || !line.starts_with(kRemarks.at(i).key)) continue;
      used.at(i) = true;
      remark = kRemarks.at(i).text;
    }
    // The file's own first line stays first.
    text += line.starts_with('#') ? line + '\n' + std::string(remark) : std::string(remark) + line + '\n';
  }
  return text;
}

}  // namespace pixelflex::calib
