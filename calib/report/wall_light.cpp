#include "calib/report/wall_light.h"

#include <algorithm>
#include <utility>

#include "calib/photometric/stacks.h"
#include "calib/store/store.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/image_error.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using devices::Image16;
using devices::ImageF;

constexpr int kChannels = 3;

/// The mean of a dark node's lit neighbours; false where it has none.
bool fillFrom(const ImageF& before, int x, int y, ImageF& after) {
  std::array<double, kChannels> sum{};
  int count = 0;
  for (int row = std::max(0, y - 1); row <= std::min(before.height() - 1, y + 1); ++row) {
    for (int column = std::max(0, x - 1); column <= std::min(before.width() - 1, x + 1); ++column) {
      if (before.at(column, row) <= 0) continue;
      for (int c = 0; c < kChannels; ++c) sum.at(static_cast<std::size_t>(c)) += before.at(column, row, c);
      ++count;
    }
  }
  for (int c = 0; c < kChannels && count > 0; ++c) {
    after.at(x, y, c) = static_cast<float>(sum.at(static_cast<std::size_t>(c)) / count);
  }
  return count > 0;
}

/// Light grows into the unseen by a node; false when there is nothing left to do, or to begin with.
bool growLight(ImageF& white) {
  const ImageF before = white;
  bool grown = false;
  for (int y = 0; y < white.height(); ++y) {
    for (int x = 0; x < white.width(); ++x) {
      if (before.at(x, y) <= 0) grown |= fillFrom(before, x, y, white);
    }
  }
  return grown;
}

std::optional<StoredLight> readLight(const fs::path& folder, const ProjectorCalibration& projector) {
  if (!projector.measured) return std::nullopt;
  const auto white = whiteFromPicture(readStoredMap(folder, projector.measured->white), projector.measured->brightest);
  StoredLight light{.share = readStoredMap(folder, projector.alpha)};
  if (!white || light.share.empty()) return std::nullopt;
  light.white = *white;
  if (projector.measured->primariesKnown) light.primaries = projector.measured->primaries;
  light.leak = projector.measured->leak ? projector.measured->leak : projector.leak;
  light.response = readStoredResponse(folder, projector);
  if (!projector.light) return light;
  light.colour = projector.light->colour;
  light.gain = readStoredMap(folder, projector.light->gain);
  light.lift = readStoredMap(folder, projector.light->black);
  light.largestLift = projector.light->largestBlack;
  return light;
}

}  // namespace

std::optional<std::size_t> WallLight::indexOf(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::optional<ImageF> whiteFromPicture(const Image16& picture, double brightest) {
  if (picture.empty() || picture.channels() < kChannels) return std::nullopt;
  ImageF white(picture.size(), kChannels);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const bool seen = picture.at(x, y, 0) > 0 && picture.at(x, y, 1) > 0 && picture.at(x, y, 2) > 0;
      for (int c = 0; c < kChannels && seen; ++c) {
        white.at(x, y, c) = static_cast<float>(picture.at(x, y, c) * brightest / 65535);
      }
    }
  }
  while (growLight(white)) {
  }
  if (white.at(0, 0) <= 0) return std::nullopt;
  return white;
}

Image16 readStoredMap(const fs::path& folder, const std::optional<std::string>& name) {
  if (!name) return {};
  try {
    return devices::readPng16(folder / *name);
  } catch (const devices::ImageError&) {
    return {};  // a report on what is there; `pixelflex check` names what is not
  }
}

std::optional<ResponseCurve> readStoredResponse(const fs::path& folder, const ProjectorCalibration& projector) {
  if (!projector.response) return std::nullopt;
  const std::string file = (folder / *projector.response).string();
  try {
    return parseReadings(readStoreFile(file), file);
  } catch (const ResponseError&) {
    return std::nullopt;
  } catch (const StoreError&) {
    return std::nullopt;
  }
}

std::optional<WallLight> readWallLight(const fs::path& folder, const Wall& wall, const Calibration& calibration) {
  if (!calibration.display || calibration.projectors.empty()) return std::nullopt;
  WallLight light{.leakKnown = true, .leftEye = wall.blend.stack == StackRule::kLeftRight};
  const std::vector<ProjectorMapping> all(calibration.projectors.begin(), calibration.projectors.end());
  const auto partners = stackPartners(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (light.leftEye && partners[i].value_or(i) < i) continue;
    const auto& projector = calibration.projectors[i];
    auto own = readLight(folder, projector);
    if (!own) return std::nullopt;
    light.matched = light.matched || projector.light.has_value();
    light.evened = light.evened || !own->lift.empty();
    light.leakKnown = light.leakKnown && own->leak.has_value();
    light.names.push_back(projector.name);
    light.projectors.emplace_back(std::move(*own), wall.transfer);
    light.mappings.push_back(all[i]);
  }
  return light;
}

}  // namespace pixelflex::calib
