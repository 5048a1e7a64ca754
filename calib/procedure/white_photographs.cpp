#include "calib/procedure/white_photographs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "calib/patterns/colour_fields.h"
#include "calib/procedure/camera_places.h"
#include "calib/procedure/procedure_error.h"

namespace pixelflex::calib {
namespace {

using devices::ImageF;

class WhitePhotographer {
 public:
  WhitePhotographer(const Calibration& calibration, const CameraResponse& camera, Method method, int nodesAcross,
                    Photographs& source)
      : calibration_(calibration), camera_(camera), method_(method), nodesAcross_(nodesAcross), source_(source) {
    for (const auto& projector : calibration.projectors) mappings_.emplace_back(projector);
  }

  std::vector<PhotographedLight> photograph(Progress& progress) {
    const std::vector<int> places = bestPlaces();
    std::vector<PhotographedLight> fields(mappings_.size());
    int done = 0;
    for (int place = 0; place < source_.placeCount(); ++place) {
      if (std::ranges::find(places, place) == places.end()) continue;
      source_.choosePlace(place);
      for (std::size_t i = 0; i < mappings_.size(); ++i) {
        if (places[i] != place) continue;
        fields[i] = photographOne(i, viewFromPlace(calibration_, place));
        progress.advance(++done, static_cast<int>(mappings_.size()), calibration_.projectors[i].name + " light");
      }
    }
    return fields;
  }

 private:
  [[nodiscard]] std::vector<int> bestPlaces() const {
    std::vector<int> best(mappings_.size(), -1);
    std::vector<double> most(mappings_.size(), 0);
    for (int place = 0; place < source_.placeCount(); ++place) {
      source_.choosePlace(place);
      const ScreenView view = viewFromPlace(calibration_, place);
      for (std::size_t i = 0; i < mappings_.size(); ++i) {
        if (!source_.hasProjector(calibration_.projectors[i].name)) continue;
        const double share = seenShare(mappings_[i], view, *calibration_.camera);
        if (share <= most[i]) continue;
        most[i] = share;
        best[i] = place;
      }
    }
    for (std::size_t i = 0; i < best.size(); ++i) {
      if (best[i] >= 0) continue;
      throw ProcedureError("projector " + calibration_.projectors[i].name +
                           ": no photograph of its white; the light cannot be matched without it");
    }
    return best;
  }

  [[nodiscard]] PhotographedLight photographOne(std::size_t i, const ScreenView& view) {
    const auto& projector = calibration_.projectors[i];
    const auto patterns = patternsOf(method_, projector.resolution);
    const auto black = source_.pattern(projector.name, patterns[0]);
    const auto white = source_.pattern(projector.name, patterns[1]);
    requireSize(black, projector.name, patterns[0]);
    requireSize(white, projector.name, patterns[1]);
    const double rows = double(nodesAcross_) * projector.resolution.height / projector.resolution.width;
    const devices::Size lattice{nodesAcross_, std::max(2, static_cast<int>(std::lround(rows)))};
    const CameraMapping camera(*calibration_.camera);
    const auto lightOf = [&](const devices::Image8& dark, const devices::Image8& bright) {
      return measureLight(dark, bright, mappings_[i], view, camera, lattice, camera_);
    };
    LightField field = lightOf(black, white);
    if (const auto longer = longerExposed(projector.name, patterns, brightest(field.light))) {
      const devices::Image8 dark(white.size(), 3);
      const double shorter = ratioOf(lightOf(dark, white).light, lightOf(dark, longer->white).light);
      field = lightOf(longer->black, longer->white);
      for (float& light : field.light.samples()) light *= static_cast<float>(shorter);
    }
    return {std::move(field), primariesOf(i, black, white, view)};
  }

  struct BlackAndWhite {
    devices::Image8 black, white;
  };

  /// A projector much dimmer than its neighbours drowns in whole codes: its light from a longer exposure, where that
  /// can be had. `brightest`: of white at the usual exposure, full scale 255.
  [[nodiscard]] std::optional<BlackAndWhite> longerExposed(const std::string& name,
                                                           const std::vector<ProjectedPattern>& patterns,
                                                           double brightest) {
    constexpr double kAim = 190;
    if (!(brightest > 0) || brightest * 2 > kAim) return std::nullopt;
    const auto range = source_.exposureRange();
    if (!range) return longerTaken(name, patterns);
    const double usual = source_.usualExposure();
    const double seconds = std::min(range->longest, usual * std::exp2(std::floor(std::log2(kAim / brightest))));
    if (seconds < 1.5 * usual) return std::nullopt;
    const PictureRegion whole{0, 0, calibration_.camera->size.width, calibration_.camera->size.height};
    return BlackAndWhite{source_.exposed(name, patterns[0], seconds, whole).photo,
                         source_.exposed(name, patterns[1], seconds, whole).photo};
  }

  /// The longest exposure of which there are both.
  [[nodiscard]] std::optional<BlackAndWhite> longerTaken(const std::string& name,
                                                         const std::vector<ProjectedPattern>& patterns) {
    if (!source_.hasExposures(name, patterns[0].name) || !source_.hasExposures(name, patterns[1].name)) return {};
    std::optional<BlackAndWhite> longest;
    double seconds = 0;
    const auto blacks = source_.exposures(name, patterns[0].name);
    for (const auto& white : source_.exposures(name, patterns[1].name)) {
      const auto black = std::ranges::find(blacks, white.seconds, &Photographs::Exposed::seconds);
      if (!white.seconds || *white.seconds <= seconds || black == blacks.end()) continue;
      requireSize(white.photo, name, patterns[1]);
      requireSize(black->photo, name, patterns[0]);
      seconds = *white.seconds;
      longest = {black->photo, white.photo};
    }
    return longest;
  }

  static double brightest(const ImageF& light) {
    return light.samples().empty() ? 0 : double(std::ranges::max(light.samples()));
  }

  /// How much less light a first photograph took in than a second, of the same.
  static double ratioOf(const ImageF& first, const ImageF& second) {
    double less = 0, more = 0;
    for (std::size_t i = 0; i < first.samples().size(); ++i) {
      if (first.samples()[i] <= 0 || second.samples()[i] <= 0) continue;
      less += first.samples()[i];
      more += second.samples()[i];
    }
    return more > 0 ? less / more : 1;
  }

  /// Sums over a coarse lattice of what the camera sees of all fields.
  [[nodiscard]] std::optional<Matrix3> primariesOf(std::size_t i, const devices::Image8& black,
                                                   const devices::Image8& white, const ScreenView& view) {
    constexpr devices::Size kLattice{16, 12};
    const auto& projector = calibration_.projectors[i];
    const auto fields = colourFields(projector.resolution);
    const bool taken =
        std::ranges::all_of(fields, [&](const auto& field) { return source_.hasPattern(projector.name, field); });
    if (!taken) return std::nullopt;
    const CameraMapping camera(*calibration_.camera);
    const auto lightOf = [&](const devices::Image8& photo) {
      return measureLight(black, photo, mappings_[i], view, camera, kLattice, camera_).light;
    };
    const ImageF all = lightOf(white);
    Matrix3 primaries{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto photo = source_.pattern(projector.name, fields[c]);
      requireSize(photo, projector.name, fields[c]);
      const auto mean = meanWhere(all, lightOf(photo));
      for (std::size_t row = 0; row < 3; ++row) primaries[3 * row + c] = mean[row];
    }
    return addedUp(primaries, meanWhere(all, all), projector.name);
  }

  void requireSize(const devices::Image8& photo, const std::string& name, const ProjectedPattern& pattern) const {
    if (photo.size() == calibration_.camera->size) return;
    throw ProcedureError(patternPath(name, pattern).string() + ": not of the size that the camera was calibrated at");
  }

  /// Mean of `light` over the nodes where white was seen.
  static std::array<double, 3> meanWhere(const ImageF& white, const ImageF& light) {
    std::array<double, 3> sum{};
    double count = 0;
    for (int y = 0; y < white.height(); ++y) {
      for (int x = 0; x < white.width(); ++x) {
        if (white.at(x, y, 1) <= 0) continue;
        for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += light.at(x, y, c);
        ++count;
      }
    }
    for (double& value : sum) value /= std::max(count, 1.0);
    return sum;
  }

  /// Red, green and blue make white, unless a photograph is another's or the exposure changed. Scaled so that they do
  /// exactly.
  static Matrix3 addedUp(Matrix3 primaries, const std::array<double, 3>& white, const std::string& name) {
    constexpr double kMostDifference = 0.15;
    for (std::size_t row = 0; row < 3; ++row) {
      const double sum = primaries[3 * row] + primaries[3 * row + 1] + primaries[3 * row + 2];
      if (!(sum > 0) || std::abs(sum / white[row] - 1) > kMostDifference) {
        throw ProcedureError("projector " + name + ": its photographs of red, green and blue together are not its " +
                             "white: exchanged, or taken with another exposure? Take them again (" + name + "/red, " +
                             name + "/green, " + name + "/blue, " + name + "/white)");
      }
      for (std::size_t c = 0; c < 3; ++c) primaries[3 * row + c] *= white[row] / sum;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (primaries[3 * c + c] * 2 > primaries[c] + primaries[3 + c] + primaries[6 + c]) continue;
      throw ProcedureError("projector " + name + ": its photographs of red, green and blue are exchanged");
    }
    return primaries;
  }

  const Calibration& calibration_;
  const CameraResponse& camera_;
  Method method_;
  int nodesAcross_;
  Photographs& source_;
  std::vector<ProjectorMapping> mappings_;
};

}  // namespace

std::vector<PhotographedLight> photographLight(const Calibration& calibration, const CameraResponse& camera,
                                               Method method, int nodesAcross, Photographs& source,
                                               Progress& progress) {
  return WhitePhotographer(calibration, camera, method, nodesAcross, source).photograph(progress);
}

std::vector<ImageF> withoutVignetting(const Calibration& calibration,
                                      const std::vector<PhotographedLight>& photographed) {
  std::vector<SeenLight> samples;
  for (std::size_t i = 0; i < photographed.size(); ++i) {
    const auto own = samplesOf(photographed[i].white, i, ProjectorMapping(calibration.projectors[i]));
    samples.insert(samples.end(), own.begin(), own.end());
  }
  const CameraVignetting vignetting = estimateVignetting(samples, photographed.size(), *calibration.camera);
  std::vector<ImageF> corrected;
  for (const auto& light : photographed) corrected.push_back(withoutVignetting(light.white, vignetting));
  return corrected;
}

}  // namespace pixelflex::calib
