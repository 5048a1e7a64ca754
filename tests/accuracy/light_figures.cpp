#include "tests/accuracy/light_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pixelflex::calib {
namespace {

enum class Unit { kPercent, kDifference, kLikeness, kRatio };

constexpr double kNoTarget = -1;

struct Description {
  Figure figure;
  const char* text;
  Unit unit;
  double target;
};

constexpr std::array<Description, kFigureCount> kFigures = {{
    {Figure::kStep16, "step across any overlap border, grey 16", Unit::kPercent, 0.015},
    {Figure::kStep32, "step, grey 32", Unit::kPercent, 0.005},
    {Figure::kStep64, "step, grey 64", Unit::kPercent, 0.005},
    {Figure::kStep128, "step, grey 128", Unit::kPercent, 0.005},
    {Figure::kStep200, "step, grey 200", Unit::kPercent, 0.005},
    {Figure::kStep255, "step, grey 255", Unit::kPercent, 0.005},
    {Figure::kUnevenness, "grey 128, RMS unevenness at uniformity 1", Unit::kPercent, 0.01},
    {Figure::kGradient, "grey 128, largest change in a degree of view at uniformity 0.5", Unit::kPercent, 0.01},
    {Figure::kBlack, "black, one projector against more of them", Unit::kPercent, 0.03},
    {Figure::kBlackStep, "black, step across any overlap border", Unit::kPercent, 0.03},
    {Figure::kGrey, "colour of grey 128 between projectors, RMS of CIEDE2000", Unit::kDifference, 1},
    {Figure::kPrimaries, "colour of primaries between projectors, RMS of CIEDE2000", Unit::kDifference, 2},
    {Figure::kInset, "step across the border of an inset of threefold density, greys 128, 200, 255", Unit::kPercent,
     0.01},
    {Figure::kInsetDark, "the same, greys 32, 64", Unit::kPercent, 0.01},
    {Figure::kSlipped, "step, grey 128, pictures slipped by 0.3 px", Unit::kPercent, 0.01},
    {Figure::kResponse, "response measured by the camera, codes 20 to 235, RMS", Unit::kPercent, 0.015},
    {Figure::kTextFine, "text, SSIM with oversampling 1.25", Unit::kLikeness, 0.88},
    {Figure::kText, "text, SSIM with oversampling 1", Unit::kLikeness, 0.84},
    {Figure::kTextSoft, "text, SSIM with oversampling 1.25, as badly focused as the rigs are", Unit::kLikeness,
     kNoTarget},
    {Figure::kBanding16, "banding in the blend, RMS, grey 16", Unit::kPercent, 0.01},
    {Figure::kBanding64, "banding, grey 64", Unit::kPercent, 0.004},
    {Figure::kWhite, "white, mean of the brightest spot that one projector makes", Unit::kPercent, kNoTarget},
    {Figure::kContrast, "contrast, mean white over mean black", Unit::kRatio, kNoTarget},
}};

const Description& describe(Figure figure) {
  return kFigures.at(static_cast<std::size_t>(figure));
}

std::string text(Unit unit, double value) {
  if (unit == Unit::kPercent) return fmt::format("{:.2f} %", 100 * value);
  if (unit == Unit::kRatio) return fmt::format("{:.0f}", value);
  return unit == Unit::kDifference ? fmt::format("{:.2f}", value) : fmt::format("{:.3f}", value);
}

bool moreIsBetter(Figure figure) {
  const Unit unit = describe(figure).unit;
  return unit == Unit::kLikeness || unit == Unit::kRatio || figure == Figure::kWhite;
}

}  // namespace

void LightFigures::add(Figure figure, Correction correction, double value, std::string where) {
  auto& values = values_.at(static_cast<std::size_t>(figure)).at(static_cast<std::size_t>(correction));
  values.push_back({value, std::move(where)});
  std::ranges::sort(values, [&](const Value& a, const Value& b) {
    return moreIsBetter(figure) ? a.value > b.value : a.value < b.value;
  });
}

std::string LightFigures::told(Figure figure, Correction correction, double value) {
  constexpr std::array kNames = {"PixelFlex", "uncorrected", "report's"};
  const auto& description = describe(figure);
  return fmt::format("{}, {}: {}", kNames.at(static_cast<std::size_t>(correction)), description.text,
                     text(description.unit, value));
}

const LightFigures::Values& LightFigures::of(Figure figure, Correction correction) const {
  return values_.at(static_cast<std::size_t>(figure)).at(static_cast<std::size_t>(correction));
}

double LightFigures::worst(Figure figure, Correction correction) const {
  const Values& values = of(figure, correction);
  return values.empty() ? 0 : values.back().value;
}

bool LightFigures::met(Figure figure) const {
  if (of(figure, Correction::kMatched).empty() || describe(figure).target == kNoTarget) return true;
  const double value = worst(figure, Correction::kMatched);
  return moreIsBetter(figure) ? value >= describe(figure).target : value <= describe(figure).target;
}

bool LightFigures::met() const {
  return std::ranges::all_of(kFigures, [&](const auto& description) { return met(description.figure); });
}

std::string LightFigures::row(Figure figure) const {
  const char* const name = describe(figure).text;
  const Unit unit = describe(figure).unit;
  const double target = describe(figure).target;
  const auto median = [&](Correction correction) {
    const Values& values = of(figure, correction);
    return values.empty() ? std::string("-") : text(unit, values[values.size() / 2].value);
  };
  const bool aimed = target != kNoTarget;
  const std::string limit = aimed ? (moreIsBetter(figure) ? "≥ " : "≤ ") + text(unit, target) : "";
  const Values& ours = of(figure, Correction::kMatched);
  const std::string worst = ours.empty() ? "-" : text(unit, ours.back().value);
  const std::string verdict = ours.empty() ? "not measured" : !aimed ? "" : met(figure) ? "met" : "missed";
  const std::string where = ours.empty() ? "" : ours.back().where;
  return fmt::format("| {} | {} | {} / {} | {} | {} | {} | {} |\n", name, limit, median(Correction::kMatched), worst,
                     median(Correction::kNone), median(Correction::kReport), verdict, where);
}

std::string LightFigures::table() const {
  std::string table =
      "| figure | target | PixelFlex, median / worst | uncorrected | report's method | | worst at |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& description : kFigures) table += row(description.figure);
  return table;
}

}  // namespace pixelflex::calib
