#include "calib/procedure/patch_photographer.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pixelflex::calib {
namespace {

constexpr double kAim = 0.6;           // of full scale, in light: bright, but clear of clipping at the brightest spot
constexpr double kDim = 0.12;          // below, a longer exposure tells more
constexpr double kLargestStep = 16;    // of exposure: what is hardly seen may be anything
constexpr double kMostClipped = 1e-3;  // of the patch
constexpr int kMostTries = 5;
constexpr int kClippedCode = 250;

double clippedPart(const devices::Image8& patch) {
  const auto clipped = std::ranges::count_if(patch.samples(), [](auto code) { return code >= kClippedCode; });
  return static_cast<double>(clipped) / static_cast<double>(patch.samples().size());
}

double brightest(const PatchLight& patch) {
  return std::ranges::max(patch.light);
}

}  // namespace

PatchPhotographer::PatchPhotographer(Photographs& source, std::string projector, const FramePatch& patch,
                                     devices::Size picture, const CameraResponse& camera)
    : source_(source), projector_(std::move(projector)), patch_(patch), picture_(picture), camera_(camera) {}

PatchLight PatchPhotographer::light(const ProjectedPattern& pattern) {
  return patchOf(photosOf(pattern, patch_.region()));
}

PatchPhotographer::Seen PatchPhotographer::see(const ProjectedPattern& pattern, const PictureRegion& region) {
  const PictureRegion& own = patch_.region();
  const Photos photos = photosOf(pattern, {std::min(own.left, region.left), std::min(own.top, region.top),
                                           std::max(own.right, region.right), std::max(own.bottom, region.bottom)});
  return {patchOf(photos), mergeExposures(photos, camera_)};
}

PatchLight PatchPhotographer::lightOf(const std::string& name) {
  return patchOf(taken(name));
}

PatchLight PatchPhotographer::patchOf(const Photos& photos) const {
  Photos patches;
  for (const auto& one : photos) patches.push_back({one.exposure, patch_.cut(one.photo)});
  return patchLight(patches, camera_);
}

PatchPhotographer::Photos PatchPhotographer::photosOf(const ProjectedPattern& pattern, const PictureRegion& region) {
  const auto range = source_.exposureRange();
  return range ? expose(pattern, region, *range) : taken(pattern.name);
}

PatchPhotographer::Photos PatchPhotographer::taken(const std::string& name) {
  Photos photos;
  for (auto& shot : source_.exposures(projector_, name)) {
    checkTold(shot);
    photos.push_back(checked(std::move(shot)));
  }
  return photos;
}

/// Exposures without times can only be one and the same.
void PatchPhotographer::checkTold(const Photographs::Exposed& shot) {
  if (!told_) {
    told_ = shot.seconds.has_value();
    first_ = shot.name;
  }
  if (*told_ == shot.seconds.has_value()) return;
  const std::string& without = *told_ ? shot.name : first_;
  const std::string& with = *told_ ? first_ : shot.name;
  throw CaptureError(without + ": its exposure is not told, while that of " + with +
                     " is: add it to the name, as in red-128@1_60.jpg");
}

PatchPhotographer::Photos PatchPhotographer::expose(const ProjectedPattern& pattern, const PictureRegion& region,
                                                    devices::ExposureRange range) {
  Photos photos;
  double seconds = ladder(expected_ > 0 ? kAim / expected_ : source_.usualExposure(), range);
  for (int tries = 0; tries < kMostTries; ++tries) {
    photos.push_back(checked(source_.exposed(projector_, pattern, seconds, region)));
    const ExposedPhoto last{photos.back().exposure, patch_.cut(photos.back().photo)};
    const bool clipped = clippedPart(last.photo) > kMostClipped;
    const double light = brightest(patchLight({&last, 1}, camera_));
    const double part = light * last.exposure;
    if (!clipped) expected_ = light;
    if (!clipped && part >= kDim) break;
    const double wanted = clipped ? seconds / 4 : seconds * std::min(kLargestStep, kAim / std::max(part, 1e-6));
    const double next = ladder(wanted, range);
    if (clipped ? next >= seconds : next <= seconds) break;
    if (clipped) photos.pop_back();
    seconds = next;
  }
  return photos;
}

/// The usual exposure times a power of two, no longer than asked for: few different ones, so that errors of the
/// camera's clock are few as well.
double PatchPhotographer::ladder(double seconds, devices::ExposureRange range) {
  const double usual = source_.usualExposure();
  const double rung = usual * std::exp2(std::floor(std::log2(seconds / usual) + 1e-9));
  return std::clamp(rung, range.shortest, range.longest);
}

ExposedPhoto PatchPhotographer::checked(Photographs::Exposed shot) const {
  if (!(shot.photo.size() == picture_)) {
    throw CaptureError(shot.name + ": not of the size that the camera was calibrated at");
  }
  return {shot.seconds.value_or(1), std::move(shot.photo)};
}

}  // namespace pixelflex::calib
