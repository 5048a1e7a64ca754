#include "viewer/panel/aim_book.h"

#include <charconv>
#include <chrono>
#include <exception>
#include <utility>

namespace pixelflex::viewer {
namespace {

std::optional<double> numberOf(const DeviceState& mirror, const std::string& setting) {
  const auto* state = mirror.find(setting);
  if (state == nullptr) return std::nullopt;
  double number = 0;
  const auto [end, error] = std::from_chars(state->value.data(), state->value.data() + state->value.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

}  // namespace

void AimBook::update(const WallSnapshot& wall) {
  std::string presets;
  for (const auto& preset : wall.presets) presets += preset.name + " " + preset.saved + "\n";
  if (!reading_.valid() && presets != presets_) {
    presets_ = presets;
    reading_ = std::async(std::launch::async, [folder = folder_] { return posesOfPresets(folder); });
  }
  if (reading_.valid() && reading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    try {
      ofPresets_ = reading_.get();
    } catch (const std::exception&) {
      ofPresets_.clear();  // the list of presets says what is wrong
    }
  }
  const bool first = !calibration_;
  if (std::exchange(calibration_, wall.calibration) != wall.calibration && !first) notePoses(wall);
}

/// A calibration that was just made belongs to where the mirrors stand now.
void AimBook::notePoses(const WallSnapshot& wall) {
  if (!wall.calibration) return;
  for (const auto& projector : wall.calibration->projectors) {
    const auto* mirror = wall.find(projector.name + ".mirror");
    if (mirror == nullptr || !mirror->doing.empty()) continue;
    const auto pan = numberOf(*mirror, "pan_counts");
    const auto tilt = numberOf(*mirror, "tilt_counts");
    if (pan && tilt) seen_[projector.name].push_back({{*pan, *tilt}, centreInWall(projector)});
  }
}

std::optional<MirrorAim> AimBook::aimOf(const WallSnapshot& wall, const std::string& projector) const {
  const auto* mirror = wall.find(projector + ".mirror");
  const auto* calibration = wall.calibration ? wall.calibration->find(projector) : nullptr;
  if (mirror == nullptr || calibration == nullptr) return std::nullopt;
  const auto* pan = mirror->find("pan");
  const auto* tilt = mirror->find("tilt");
  if (pan == nullptr || tilt == nullptr) return std::nullopt;
  std::vector<AimPose> poses;
  for (const auto* book : {&ofPresets_, &seen_}) {
    const auto its = book->find(projector);
    if (its != book->end()) poses.insert(poses.end(), its->second.begin(), its->second.end());
  }
  return aimByPoses(aimByGeometry(*calibration, {pan->info.step, tilt->info.step}), poses);
}

}  // namespace pixelflex::viewer
