#include "calib/estimate/joint_solve.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "calib/estimate/lens_residual.h"
#include "calib/estimate/place_chain.h"

namespace pixelflex::calib {
namespace {

// Standard deviations that weigh the three kinds of measurement against each other.
constexpr double kBlobInCamera = 0.03;  // camera pixels
constexpr double kLens = 0.03;          // projector pixels: how far a lens is from Brown's model
constexpr double kMarkerInCamera = 0.1;
constexpr double kHuber = 5;           // standard deviations
constexpr double kCameraScale = 1000;  // camera pixels become numbers of order one

/// A homography whose ninth number is 1, of a wall point to camera pixels over kCameraScale.
template <class T>
void cameraPixel(const T* h, const T* pointInWall, T* pixel) {
  const T w = h[6] * pointInWall[0] + h[7] * pointInWall[1] + T(1);
  pixel[0] = (h[0] * pointInWall[0] + h[1] * pointInWall[1] + h[2]) / w * kCameraScale;
  pixel[1] = (h[3] * pointInWall[0] + h[4] * pointInWall[1] + h[5]) / w * kCameraScale;
}

struct CameraResidual {
  glm::dvec2 seen;
  template <class T>
  bool operator()(const T* place, const T* point, T* residual) const {
    cameraPixel(place, point, residual);
    residual[0] = (residual[0] - seen.x) / kBlobInCamera;
    residual[1] = (residual[1] - seen.y) / kBlobInCamera;
    return true;
  }
};

struct MarkerResidual {
  glm::dvec2 seen;
  glm::dvec2 inWall;
  template <class T>
  bool operator()(const T* place, T* residual) const {
    const T point[2] = {T(inWall.x), T(inWall.y)};
    cameraPixel(place, point, residual);
    residual[0] = (residual[0] - seen.x) / kMarkerInCamera;
    residual[1] = (residual[1] - seen.y) / kMarkerInCamera;
    return true;
  }
};

struct LensResidual {
  glm::dvec2 shown;  // projector pixels from the frame's middle
  double scale;
  template <class T>
  bool operator()(const T* h, const T* radial, const T* tangential, const T* centre, const T* point,
                  T* residual) const {
    const T onPlane[3] = {point[0], point[1], T(0)};
    const T flat[3] = {T(0), T(0), T(0)};
    lensPixel(h, flat, radial, tangential, centre, scale, onPlane, residual);
    residual[0] = (residual[0] - shown.x) / kLens;
    residual[1] = (residual[1] - shown.y) / kLens;
    return true;
  }
};

std::array<double, 8> eightOf(const Homography& h) {
  std::array<double, 8> eight{};
  for (std::size_t i = 0; i < 8; ++i) eight[i] = h.rowMajor()[i] / h.rowMajor()[8];
  return eight;
}

Homography homographyOf(const std::array<double, 8>& eight) {
  std::array<double, 9> h{};
  std::ranges::copy(eight, h.begin());
  h[8] = 1;
  return Homography(h);
}

struct Lens {
  std::array<double, 8> view{};
  std::array<double, 3> radial{};
  std::array<double, 2> tangential{};
  std::array<double, 2> centre{};
};

class Adjustment {
 public:
  Adjustment(const JointProblem& problem, const ChainedPlaces& chain) : problem_(problem), chain_(chain) {
    normaliseWall();
    startPlaces();
    startLenses();
  }

  std::vector<SurfaceFit> solve() {
    for (const auto& observation : problem_.observations) addObservation(observation);
    addLenses();
    addFiducials();
    run();
    std::vector<SurfaceFit> surfaces;
    for (std::size_t place = 0; place < places_.size(); ++place) surfaces.push_back(surfaceOf(place));
    return surfaces;
  }

 private:
  /// Wall coordinates of unit spread about the points' mean.
  void normaliseWall() {
    glm::dvec2 mean{0, 0};
    for (const auto& [key, point] : chain_.points) mean += point / static_cast<double>(chain_.points.size());
    double spread = 0;
    for (const auto& [key, point] : chain_.points) {
      spread += std::hypot(point.x - mean.x, point.y - mean.y) / static_cast<double>(chain_.points.size());
    }
    normalise_ = Homography::scaling(glm::dvec2(1 / spread)) * Homography::translation(-mean);
    for (const auto& [key, point] : chain_.points) {
      const glm::dvec2 normalised = normalise_.map(point);
      points_[key] = {normalised.x, normalised.y};
    }
  }

  void startPlaces() {
    const Homography wallFromNormalised = normalise_.inverse();
    for (const auto& wallFromCamera : chain_.wallFromCamera) {
      places_.push_back(
          eightOf(Homography::scaling(glm::dvec2(1 / kCameraScale)) * wallFromCamera.inverse() * wallFromNormalised));
    }
  }

  void startLenses() {
    lenses_.resize(problem_.resolutions.size());
    for (std::size_t i = 0; i < lenses_.size(); ++i) {
      std::vector<PointPair> pairs;
      const devices::Size size = problem_.resolutions[i];
      const glm::dvec2 middle(size.width / 2.0, size.height / 2.0);
      for (const auto& [key, point] : points_) {
        if (key.projector != i) continue;
        pairs.push_back({{point[0], point[1]}, (key.inProjector() - middle) / double(size.width)});
      }
      if (pairs.size() >= 4) lenses_[i].view = eightOf(solveCollineation(pairs));
    }
  }

  void addObservation(const JointObservation& observation) {
    for (const auto& point : observation.points) {
      auto& unknown = points_.at(PointKey(observation.projector, point.source));
      ceres_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<CameraResidual, 2, 8, 2>(new CameraResidual{point.target}),
          new ceres::HuberLoss(kHuber), places_[observation.place].data(), unknown.data());
    }
  }

  void addLenses() {
    for (auto& [key, point] : points_) {
      Lens& lens = lenses_[key.projector];
      const devices::Size size = problem_.resolutions[key.projector];
      const glm::dvec2 shown = key.inProjector() - glm::dvec2(size.width / 2.0, size.height / 2.0);
      ceres_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<LensResidual, 2, 8, 3, 2, 2, 2>(new LensResidual{shown, double(size.width)}),
          new ceres::HuberLoss(kHuber), lens.view.data(), lens.radial.data(), lens.tangential.data(),
          lens.centre.data(), point.data());
    }
    for (auto& lens : lenses_) {
      ceres_.AddResidualBlock(new ceres::AutoDiffCostFunction<LensCentrePrior, 2, 2>(new LensCentrePrior), nullptr,
                              lens.centre.data());
    }
  }

  void addFiducials() {
    for (std::size_t place = 0; place < places_.size(); ++place) {
      for (const auto& fiducial : problem_.fiducials[place]) {
        ceres_.AddResidualBlock(new ceres::AutoDiffCostFunction<MarkerResidual, 2, 8>(
                                    new MarkerResidual{fiducial.source, normalise_.map(fiducial.target)}),
                                new ceres::HuberLoss(kHuber), places_[place].data());
      }
    }
  }

  void run() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-12;
    options.num_threads = 1;  // the same photographs give the same bits
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_, &summary);
    if (!summary.IsSolutionUsable()) throw EstimateError("the places cannot be solved together: " + summary.message);
  }

  [[nodiscard]] SurfaceFit surfaceOf(std::size_t place) const {
    const Homography cameraFromWall =
        Homography::scaling(glm::dvec2(kCameraScale)) * homographyOf(places_[place]) * normalise_;
    const Homography wallFromCamera = cameraFromWall.inverse();
    return {wallFromCamera.rowMajor(), rmsError(wallFromCamera, problem_.fiducials[place]), {}};
  }

  const JointProblem& problem_;
  const ChainedPlaces& chain_;
  Homography normalise_;  // normalised from wall
  std::vector<std::array<double, 8>> places_;
  std::vector<Lens> lenses_;
  std::map<PointKey, std::array<double, 2>> points_;  // normalised wall; nodes stay where they are, as Ceres needs
  ceres::Problem ceres_;
};

/// Enough of every projector: more only takes time.
JointProblem thinned(const JointProblem& problem) {
  constexpr std::size_t kMost = 200;
  JointProblem thin{problem.fiducials, problem.resolutions, {}};
  for (const auto& observation : problem.observations) {
    JointObservation kept{observation.place, observation.projector, {}};
    const std::size_t step = 1 + observation.points.size() / kMost;
    for (const auto& point : observation.points) {
      // By its own place, so that every camera place keeps the same ones.
      const auto lattice = static_cast<std::size_t>(std::lround(point.source.x * 7 + point.source.y * 131));
      if (step == 1 || lattice % step == 0) kept.points.push_back(point);
    }
    thin.observations.push_back(std::move(kept));
  }
  return thin;
}

}  // namespace

std::vector<SurfaceFit> solvePlaces(const JointProblem& problem) {
  const JointProblem thin = thinned(problem);
  const ChainedPlaces chain = chainPlaces(thin);
  return Adjustment(thin, chain).solve();
}

}  // namespace pixelflex::calib
