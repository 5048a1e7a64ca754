#include "tests/accuracy/light_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "devices/image/png_file.h"
#include "tests/accuracy/light_measures.h"
#include "tests/accuracy/seen_wall.h"
#include "tests/accuracy/text_likeness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/light_session.h"
#include "tests/support_calibration/response_error.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

constexpr double kViewScale = 2;  // desktop pixels per view pixel: as fine as eyes that blur by two
constexpr double kSlip = 0.3;     // projector pixels
constexpr double kFine = 1.25;    // oversampling

constexpr std::array kSteps = {std::pair(Figure::kStep16, 16),   std::pair(Figure::kStep32, 32),
                               std::pair(Figure::kStep64, 64),   std::pair(Figure::kStep128, 128),
                               std::pair(Figure::kStep200, 200), std::pair(Figure::kStep255, 255)};

double lightOfSrgb(int code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double meanOf(const ImageF& luminance) {
  double sum = 0;
  for (const float value : luminance.samples()) sum += value;
  return sum / static_cast<double>(luminance.samples().size());
}

/// The blends that are measured: one flat, one that gives away less light. Insets: once winning, once by equation 7.
Blend flatBlend(const LightRig& kind) {
  Blend blend{.uniformity = 1, .evenBlack = true};
  if (kind.inset) blend.priorityFeather = 60;
  return blend;
}
Blend usualBlend() {
  return {.uniformity = 0.5, .evenBlack = true};
}

Display displayOf(const Calibration& calibration) {
  if (!calibration.display) throw std::runtime_error("the calibration has no display");
  return *calibration.display;
}

/// One rig, calibrated, and where its figures go.
class LightBench {
 public:
  LightBench(const LightRig& kind, std::uint32_t seed, const Findings& findings)
      : kind_(kind),
        findings_(findings),
        where_(fmt::format("{} {}", kind.name, seed)),
        room_(kind.make(seed)),
        slippedRoom_(slipped(room_.rig(), kSlip)),
        session_(room_, folder_.path(), flatBlend(kind)),
        display_(displayOf(session_.calibration())),
        view_(room_, withoutRim(display_), kViewScale),
        slippedView_(slippedRoom_, withoutRim(display_), kViewScale) {}

  void measureOurs() {
    SeenWall flat(showMatched(room_.rig(), plan(), display_.resolution), display_.resolution, view_);
    measureSteps(Correction::kMatched, flat);
    measureFlat(Correction::kMatched, flat);
    session_.match(usualBlend());
    SeenWall usual(showMatched(room_.rig(), plan(), display_.resolution), display_.resolution, view_);
    measureSteps(Correction::kMatched, usual);
    addSteepest(Correction::kMatched, usual);
    if (kind_.text) measureText(Correction::kMatched, showMatched);
    if (kind_.response) measureResponse();
  }

  template <class Make>
  void measureOther(Correction correction, const Make& make) {
    SeenWall wall(make(room_.rig(), plan(), display_.resolution), display_.resolution, view_);
    measureSteps(correction, wall);
    measureFlat(correction, wall);
    addSteepest(correction, wall);
    if (kind_.text) measureText(correction, make);
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  [[nodiscard]] viewer::WallPlan plan() const {
    return {session_.folder(), session_.wall(), session_.calibration(), {}};
  }

  void measureSteps(Correction correction, SeenWall& wall) {
    for (const auto& [figure, code] : kSteps) {
      const BorderStep step = largestStep(view_, wall.luminance(code));
      if (!kind_.inset) {
        addStep(figure, correction, step);
      } else if (code >= 32) {
        const Figure figureOfInset = code >= 128 ? Figure::kInset : Figure::kInsetDark;
        add(figureOfInset, correction, step.step, fmt::format(" grey {}{}", code, placeText(step.at)));
      }
    }
  }

  /// What is asked for at uniformity 1.
  void measureFlat(Correction correction, SeenWall& wall) {
    const ImageF black = wall.luminance(0), white = wall.luminance(255);
    add(Figure::kUnevenness, correction, unevenness(wall.luminance(128)));
    if (!kind_.inset) {
      add(Figure::kBlack, correction, blackStep(view_, black));
      addStep(Figure::kBlackStep, correction, largestStep(view_, black));
      const auto moved = luminanceOf(slippedView_.seen(wall.frames({128, 128, 128})));
      addStep(Figure::kSlipped, correction, largestStep(slippedView_, moved));
    }
    for (const auto& [figure, code] : {std::pair(Figure::kBanding16, 16), std::pair(Figure::kBanding64, 64)}) {
      add(figure, correction, banding(view_, {black, white, wall.luminance(code), lightOfSrgb(code)}));
    }
    add(Figure::kWhite, correction, meanOf(white));
    add(Figure::kContrast, correction, meanOf(white) / meanOf(black));
    measureColours(correction, wall);
  }

  void measureColours(Correction correction, SeenWall& wall) {
    const glm::dvec3 white = meanColour(wall.seen({255, 255, 255}));
    add(Figure::kGrey, correction, difference(wall.seen({128, 128, 128}), white));
    double squares = 0;
    for (const Colour& primary : {Colour{255, 0, 0}, Colour{0, 255, 0}, Colour{0, 0, 255}}) {
      squares += std::pow(difference(wall.seen(primary), white), 2);
    }
    add(Figure::kPrimaries, correction, std::sqrt(squares / 3));
  }

  [[nodiscard]] double difference(const ImageF& light, glm::dvec3 white) const {
    std::vector<glm::dvec3> colours;
    for (std::size_t i = 0; i < room_.projectorCount(); ++i) colours.push_back(colourOfProjector(view_, light, i));
    return colourDifference(colours, white);
  }

  template <class Make>
  void measureText(Correction correction, const Make& make) {
    const SimulatedWall sharpRoom(focused(room_.rig()));
    for (const auto& [figure, oversampling] : {std::pair(Figure::kText, 1.0), std::pair(Figure::kTextFine, kFine)}) {
      Display display = display_;
      display.resolution = {static_cast<int>(std::lround(display_.resolution.width / oversampling)),
                            static_cast<int>(std::lround(display_.resolution.height / oversampling))};
      const Show show = make(room_.rig(), plan(), display.resolution);
      add(figure, correction, likeness(sharpRoom, display, show));
      if (figure == Figure::kTextFine) add(Figure::kTextSoft, correction, likeness(room_, display, show));
    }
  }

  /// Beside what is assumed without measuring: sRGB.
  void measureResponse() {
    ResponseCurve assumed;
    for (auto& channel : assumed.light) {
      for (std::size_t code = 0; code < channel.size(); ++code) channel.at(code) = lightOfSrgb(static_cast<int>(code));
    }
    for (std::size_t i = 0; i < room_.projectorCount(); ++i) {
      const std::string name = " " + room_.rig().projectors[i].name;
      add(Figure::kResponse, Correction::kMatched, responseError(session_.responseByCamera(i), room_, i), name);
      add(Figure::kResponse, Correction::kNone, responseError(assumed, room_, i), name);
    }
  }

  static double likeness(const SimulatedWall& room, const Display& display, const Show& show) {
    const WallView view(room, display, 1);
    const Image8 desktop =
        textDesktop(devices::readPng8(PIXELFLEX_SOURCE_DIR "/tests/data/text.png"), display.resolution);
    const double white = meanOf(luminanceOf(view.light(show(plainDesktop(display.resolution, {255, 255, 255})))));
    return likenessToDesktop(luminanceOf(view.light(show(desktop))), white, desktop);
  }

  void add(Figure figure, Correction correction, double value, const std::string& place = "") const {
    findings_(figure, correction, value, where_ + place);
  }
  void addStep(Figure figure, Correction correction, const BorderStep& step) const {
    add(figure, correction, step.step, " " + room_.rig().projectors[step.projector].name + placeText(step.at));
  }
  void addSteepest(Correction correction, SeenWall& wall) const {
    const SteepPlace steepest = steepestPerDegree(view_, wall.luminance(128));
    add(Figure::kGradient, correction, steepest.change, placeText(steepest.at));
  }
  /// In desktop pixels.
  [[nodiscard]] static std::string placeText(glm::dvec2 at) {
    return fmt::format(" ({:.0f}, {:.0f})", kRim + kViewScale * at.x, kRim + kViewScale * at.y);
  }

  const LightRig& kind_;
  const Findings& findings_;
  std::string where_;
  testing::TemporaryFolder folder_;
  SimulatedWall room_;
  SimulatedWall slippedRoom_;
  LightSession session_;
  Display display_;
  WallView view_;
  WallView slippedView_;
};

}  // namespace

void measureLight(const LightRig& kind, std::uint32_t seed, bool others, const Findings& findings) {
  LightBench bench(kind, seed, findings);
  bench.measureOurs();
  if (!others) return;
  bench.measureOther(Correction::kNone, showUncorrected);
  bench.measureOther(Correction::kReport, [&](const Rig& rig, const viewer::WallPlan& plan, devices::Size size) {
    return showAsInReport(rig, plan, size, bench.folder());
  });
}

}  // namespace pixelflex::calib
