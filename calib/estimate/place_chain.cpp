#include "calib/estimate/place_chain.h"

#include <algorithm>
#include <optional>
#include <string>

namespace pixelflex::calib {
namespace {

constexpr std::size_t kFewestShared = 20;

/// Everything in the undistorted pixels of the place that sees most, until the fiducials turn it into wall units.
class Chain {
 public:
  explicit Chain(const JointProblem& problem) : problem_(problem), referenceFromCamera_(problem.fiducials.size()) {}

  ChainedPlaces link() {
    addPlace(richest(), Homography());
    while (const auto next = bestLinked()) addPlace(*next, solveCollineation(shared(*next)));
    for (std::size_t place = 0; place < referenceFromCamera_.size(); ++place) {
      if (!referenceFromCamera_[place]) throwUnlinked(place);
    }
    return inWallUnits();
  }

 private:
  [[nodiscard]] std::size_t richest() const {
    std::vector<std::size_t> seen(referenceFromCamera_.size());
    for (const auto& observation : problem_.observations) seen[observation.place] += observation.points.size();
    return static_cast<std::size_t>(std::ranges::max_element(seen) - seen.begin());
  }

  void addPlace(std::size_t place, const Homography& referenceFromCamera) {
    referenceFromCamera_[place] = referenceFromCamera;
    for (const auto& observation : problem_.observations) {
      if (observation.place != place) continue;
      for (const auto& point : observation.points) {
        points_.try_emplace(PointKey(observation.projector, point.source), referenceFromCamera.map(point.target));
      }
    }
  }

  /// Pairs from this place's camera pixels to the reference: what was seen from another place too.
  [[nodiscard]] std::vector<PointPair> shared(std::size_t place) const {
    std::vector<PointPair> pairs;
    for (const auto& observation : problem_.observations) {
      if (observation.place != place) continue;
      for (const auto& point : observation.points) {
        const auto known = points_.find(PointKey(observation.projector, point.source));
        if (known != points_.end()) pairs.push_back({point.target, known->second});
      }
    }
    return pairs;
  }

  [[nodiscard]] std::optional<std::size_t> bestLinked() const {
    std::optional<std::size_t> best;
    std::size_t most = kFewestShared - 1;
    for (std::size_t place = 0; place < referenceFromCamera_.size(); ++place) {
      if (referenceFromCamera_[place]) continue;
      const std::size_t count = shared(place).size();
      if (count <= most) continue;
      most = count;
      best = place;
    }
    return best;
  }

  [[noreturn]] void throwUnlinked(std::size_t place) const {
    throw EstimateError("camera place " + std::to_string(place + 1) + " shares only " +
                        std::to_string(shared(place).size()) + " points with the others, and " +
                        std::to_string(kFewestShared) +
                        " are needed: take it so that it shows at least one projector that another place shows too");
  }

  [[nodiscard]] ChainedPlaces inWallUnits() const {
    std::vector<PointPair> pairs;
    for (std::size_t place = 0; place < referenceFromCamera_.size(); ++place) {
      for (const auto& fiducial : problem_.fiducials[place]) {
        pairs.push_back({referenceFromCamera_[place]->map(fiducial.source), fiducial.target});
      }
    }
    const Homography wallFromReference = solveCollineation(pairs);
    ChainedPlaces chain;
    for (const auto& referenceFromCamera : referenceFromCamera_) {
      chain.wallFromCamera.push_back(wallFromReference * *referenceFromCamera);
    }
    for (const auto& [key, point] : points_) chain.points[key] = wallFromReference.map(point);
    return chain;
  }

  const JointProblem& problem_;
  std::vector<std::optional<Homography>> referenceFromCamera_;
  std::map<PointKey, glm::dvec2> points_;  // in the reference
};

}  // namespace

ChainedPlaces chainPlaces(const JointProblem& problem) {
  return Chain(problem).link();
}

}  // namespace pixelflex::calib
