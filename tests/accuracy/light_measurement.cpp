#include "tests/accuracy/light_measurement.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "devices/image/png_file.h"
#include "tests/accuracy/light_measures.h"
#include "tests/accuracy/shown_wall.h"
#include "tests/accuracy/text_likeness.h"
#include "tests/accuracy/wall_view.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/light_session.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

constexpr double kViewScale = 2;  // desktop pixels per view pixel: as fine as the eye that blurs by two
constexpr double kSlip = 0.3;     // projector pixels
constexpr double kOversampling = 1.25;

constexpr std::array kSteps = {std::pair(Figure::kStep16, 16),   std::pair(Figure::kStep32, 32),
                               std::pair(Figure::kStep64, 64),   std::pair(Figure::kStep128, 128),
                               std::pair(Figure::kStep200, 200), std::pair(Figure::kStep255, 255)};

double lightOfSrgb(int code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Image8 plain(devices::Size size, std::array<int, 3> colour) {
  Image8 desktop(size, 4);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int c = 0; c < 3; ++c)
        desktop.at(x, y, c) = static_cast<std::uint8_t>(colour.at(static_cast<std::size_t>(c)));
      desktop.at(x, y, 3) = 255;
    }
  }
  return desktop;
}

/// One rig, calibrated.
class Bench {
 public:
  Bench(const LightRig& kind, std::uint32_t seed, LightFigures& figures,
        const std::function<void(const std::string&)>& tell)
      : kind_(kind),
        figures_(figures),
        tell_(tell),
        where_(fmt::format("{} {}", kind.name, seed)),
        room_(kind.make(seed)),
        slippedRoom_(slipped(room_.rig(), kSlip)),
        session_(room_, folder_.path()),
        display_(session_.calibration().display.value()),
        view_(room_, withoutRim(display_), kViewScale),
        slippedView_(slippedRoom_, withoutRim(display_), kViewScale) {}

  void measureOurs() {
    const Blend flat = {.uniformity = 1, .evenBlack = true};
    const auto level = showOf(flat);
    measureSteps(Correction::kMatched, level);
    measureFlat(Correction::kMatched, level);
    const Blend usual = {.uniformity = 0.5, .evenBlack = true};
    const auto sloping = showOf(usual);
    measureSteps(Correction::kMatched, sloping);
    addSteepest(Correction::kMatched, sloping);
    if (kind_.text) measureText(Correction::kMatched, &showMatched);
  }

  void measureUncorrected() {
    const auto show = showUncorrected(room_.rig(), planOf(), display_.resolution);
    measureOther(Correction::kNone, show);
    if (kind_.text) measureText(Correction::kNone, &showUncorrected);
  }

  void measureReport() {
    const auto make = [&](const Rig& rig, const viewer::WallPlan& plan, devices::Size size) {
      return showAsInReport(rig, plan, size, folder_.path());
    };
    measureOther(Correction::kReport, make(room_.rig(), planOf(), display_.resolution));
    if (kind_.text) measureText(Correction::kReport, make);
  }

 private:
  [[nodiscard]] viewer::WallPlan planOf() const {
    return {session_.folder(), session_.wall(), session_.calibration(), {}};
  }

  [[nodiscard]] Show showOf(const Blend& blend) {
    session_.match(blend);
    return showMatched(room_.rig(), planOf(), display_.resolution);
  }

  void measureOther(Correction correction, const Show& show) {
    measureSteps(correction, show);
    measureFlat(correction, show);
    addSteepest(correction, show);
  }

  [[nodiscard]] ImageF seen(const Show& show, std::array<int, 3> colour) const {
    return view_.seen(show(plain(display_.resolution, colour)));
  }
  [[nodiscard]] ImageF grey(const Show& show, int code) const { return luminanceOf(seen(show, {code, code, code})); }

  void measureSteps(Correction correction, const Show& show) {
    double largest = 0;
    for (const auto& [figure, code] : kSteps) {
      const BorderStep step = largestStep(view_, grey(show, code));
      if (!kind_.inset) {
        addStep(figure, correction, step);
      } else if (code >= 32) {
        largest = std::max(largest, step.step);
      }
    }
    if (kind_.inset) add(Figure::kInset, correction, largest);
  }

  /// What is asked for at uniformity 1.
  void measureFlat(Correction correction, const Show& show) {
    const ImageF black = grey(show, 0), white = grey(show, 255), middle = grey(show, 128);
    add(Figure::kUnevenness, correction, unevenness(middle));
    if (!kind_.inset) {
      add(Figure::kBlack, correction, blackStep(view_, black));
      addStep(Figure::kBlackStep, correction, largestStep(view_, black));
      const auto slippedGrey = slippedView_.seen(show(plain(display_.resolution, {128, 128, 128})));
      addStep(Figure::kSlipped, correction, largestStep(slippedView_, luminanceOf(slippedGrey)));
    }
    for (const auto& [figure, code] : {std::pair(Figure::kBanding16, 16), std::pair(Figure::kBanding64, 64)}) {
      add(figure, correction, banding(view_, {black, white, grey(show, code), lightOfSrgb(code)}));
    }
    measureColours(correction, show);
  }

  void measureColours(Correction correction, const Show& show) {
    const glm::dvec3 white = meanColour(seen(show, {255, 255, 255}));
    add(Figure::kGrey, correction, difference(show, {128, 128, 128}, white));
    double squares = 0;
    for (const std::array<int, 3>& primary : {std::array{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}) {
      squares += std::pow(difference(show, primary, white), 2);
    }
    add(Figure::kPrimaries, correction, std::sqrt(squares / 3));
  }

  [[nodiscard]] double difference(const Show& show, std::array<int, 3> colour, glm::dvec3 white) const {
    const ImageF light = seen(show, colour);
    std::vector<glm::dvec3> colours;
    for (std::size_t i = 0; i < room_.projectorCount(); ++i) colours.push_back(colourOfProjector(view_, light, i));
    return colourDifference(colours, white);
  }

  template <class Make>
  void measureText(Correction correction, const Make& make) {
    const Image8 text = devices::readPng8(PIXELFLEX_SOURCE_DIR "/tests/data/text.png");
    for (const auto& [figure, oversampling] :
         {std::pair(Figure::kText, 1.0), std::pair(Figure::kTextFine, kOversampling)}) {
      const devices::Size size{static_cast<int>(std::lround(display_.resolution.width / oversampling)),
                               static_cast<int>(std::lround(display_.resolution.height / oversampling))};
      Display display = display_;
      display.resolution = size;
      const WallView view(room_, display, 1);
      const Show show = make(room_.rig(), planOf(), size);
      const Image8 desktop = textDesktop(text, size);
      const glm::dvec3 white = meanColour(view.light(show(plain(size, {255, 255, 255}))));
      const ImageF luminance = luminanceOf(view.light(show(desktop)));
      add(figure, correction, likenessToDesktop(luminance, glm::dot(white, kLuminance), desktop));
    }
  }

  void add(Figure figure, Correction correction, double value, const std::string& place = "") {
    figures_.add(figure, correction, value, where_ + place);
    tell_(where_ + place + ": " + LightFigures::told(figure, correction, value));
  }
  void addStep(Figure figure, Correction correction, const BorderStep& step) {
    add(figure, correction, step.step, " " + room_.rig().projectors[step.projector].name + placeText(step.at));
  }
  void addSteepest(Correction correction, const Show& show) {
    const SteepPlace steepest = steepestPerDegree(view_, grey(show, 128));
    add(Figure::kGradient, correction, steepest.change, placeText(steepest.at));
  }
  /// In desktop pixels.
  [[nodiscard]] static std::string placeText(glm::dvec2 at) {
    return fmt::format(" ({:.0f}, {:.0f})", kViewScale * at.x, kViewScale * at.y);
  }

  static constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};
  const LightRig& kind_;
  LightFigures& figures_;
  const std::function<void(const std::string&)>& tell_;
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

void measureLight(const LightRig& kind, std::uint32_t seed, bool others, LightFigures& figures,
                  const std::function<void(const std::string&)>& tell) {
  Bench bench(kind, seed, figures, tell);
  bench.measureOurs();
  if (!others) return;
  bench.measureUncorrected();
  bench.measureReport();
}

}  // namespace pixelflex::calib
