#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib/store/nudge.h"
#include "devices/image/size.h"

namespace pixelflex::calib {

/// A pinhole camera with Brown's distortion (the contract's file order: radial and tangential apart). Pixel coordinates
/// have their origin at the corner of the top-left pixel, so cx is half a pixel more than OpenCV's.
struct CameraIntrinsics {
  devices::Size size;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::array<double, 3> radial{};
  std::array<double, 2> tangential{};
  double rmsPx = 0;  // reprojection error of the checkerboard corners
  int photos = 0;
  /// 256 rows value,red,green,blue: the light of the codes of its photographs; relative to the wall's folder. None: as
  /// wall.yaml says, else linear.
  std::optional<std::string> response;
  bool operator==(const CameraIntrinsics&) const = default;
};

/// How a view (a camera's or a projector's) sees a screen that is bent about a vertical axis. Wall x runs along the
/// arc. With t = (x - apex) / radius the wall point (x, y) lies at X = apex + radius sin t, Y = y and
/// Z = radius (cos t - 1) in a frame whose plane Z = 0 touches the screen at the apex, and is seen at
/// H (X, Y, 1) + depth Z, where H is the view's homography of that plane.
struct Bend {
  double radius = 0;  // wall units; positive: hollow towards the audience, negative: bulging
  double apex = 0;    // wall x
  std::array<double, 3> depth{};
  bool operator==(const Bend&) const = default;
};

/// The collineation C of the report: undistorted camera pixel to wall (equation 6).
struct SurfaceFit {
  std::array<double, 9> wallFromCamera{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row major; of the apex's plane on a bent screen
  double rms = 0;                                                   // wall units, over the fiducials
  std::optional<Bend> bend;                                         // goes with the inverse of wallFromCamera
  bool operator==(const SurfaceFit&) const = default;
};

struct Display {
  double left = 0, top = 0, right = 0, bottom = 0;  // wall units
  devices::Size resolution;                         // the desktop that fills it
  bool operator==(const Display&) const = default;
};

/// One measured correspondence.
struct Sample {
  glm::dvec2 pointInProjector{0, 0};
  glm::dvec2 pointInWall{0, 0};
  bool operator==(const Sample&) const = default;
};

/// What the lens model leaves, as a smooth correction in projector pixels: a uniform cubic B-spline of columns x rows
/// cells over the frame. A pixel p of the lens model becomes p + spline(p); outside the frame the correction is that of
/// the nearest point of its border.
struct ResidualSpline {
  int columns = 0;
  int rows = 0;
  std::vector<glm::dvec2> control;  // (columns + 3) x (rows + 3), row by row
  bool operator==(const ResidualSpline&) const = default;
};

/// Homography and Brown lens (calibration reference 1.6). A wall point w goes to h = projectorFromWall * w (normalised
/// plane), through Brown's polynomial about the lens centre, to pixel = centre + scale * distorted, and is then moved
/// by the residual spline where there is one.
struct ProjectorModel {
  std::array<double, 9> projectorFromWall{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row major, into normalised coordinates
  glm::dvec2 centre{0, 0};                                             // projector pixels
  double scale = 1;                                                    // projector pixels per normalised unit
  std::array<double, 3> radial{};
  std::array<double, 2> tangential{};
  std::optional<Bend> bend;  // goes with projectorFromWall
  std::optional<ResidualSpline> residual;
  bool operator==(const ProjectorModel&) const = default;
};

/// How well the model explains the samples it was fitted to, in projector pixels.
struct FitQuality {
  double rms = 0, p95 = 0, maximum = 0;
  int found = 0;  // samples located and identified
  int shown = 0;
  double heldOut = 0;      // rms of samples left out of the fit (five folds): what to expect between samples
  double deviation = 0;    // standard deviation of the model from the fit's covariance, rms over the frame
  double cameraScale = 0;  // camera pixels per projector pixel; 0: not known
  bool operator==(const FitQuality&) const = default;
};

/// Where a calibration does not say it.
inline constexpr double kLargestBlackLift = 0.0625;

/// What makes the projectors' light alike. Linear light x of the desktop (1 is white) becomes
/// alpha * gain * (colour x) + largestBlack * black in this projector's own linear light, per channel, before its
/// inverse response.
struct LightMatch {
  std::array<double, 9> colour{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row major
  std::optional<std::string>
      gain;  // 16-bit grey PNG stretched over the frame, 65535 = 1; relative to the wall's folder
  std::optional<std::string> black;  // 16-bit grey PNG of the projector's resolution, 65535 = 1
  std::array<double, 3> largestBlack{kLargestBlackLift, kLargestBlackLift, kLargestBlackLift};  // red, green and blue
  bool operator==(const LightMatch&) const = default;
};

/// A projector's light as the camera saw it, in the camera's linear channels.
struct MeasuredLight {
  std::string white;     // 16-bit RGB PNG stretched over the frame, samples in the middles of equal cells: white above
                         // black, the camera's vignetting divided out, 0 where it was not seen; relative to the folder
  double brightest = 1;  // what 65535 stands for, in a unit that all projectors of the wall share
  std::array<double, 9> primaries{};  // row major; the columns are what full red, green and blue add to the mean white
  bool primariesKnown = false;        // from photographs of them; else each channel is taken to be seen by one of ours
  std::optional<double> leak;         // of black, in white above black
  bool operator==(const MeasuredLight&) const = default;
};

struct ProjectorCalibration {
  std::string name;
  devices::Size resolution;
  std::vector<Sample> samples;
  ProjectorModel model;
  FitQuality quality;
  std::optional<std::string> alpha;  // 16-bit PNG of the projector's resolution, relative to the wall's folder
  std::optional<std::string>
      response;  // 256 rows value,red,green,blue; normalised light, relative to the wall's folder
  std::optional<MeasuredLight> measured;
  std::optional<double> responseError;  // relative to light, RMS, where the camera measured the response
  std::optional<double> leak;           // light of black over white above black, where that is known
  std::optional<LightMatch> light;
  std::optional<Nudge> nudge;        // from nudge.yaml; not part of calibration.yaml
  std::optional<glm::ivec2> flatAt;  // an exact screen: shows desktop pixels one to one from here
  bool operator==(const ProjectorCalibration&) const = default;
};

/// calibration.yaml: what was measured. Parts are absent until their step has run.
struct Calibration {
  std::optional<CameraIntrinsics> camera;
  std::optional<SurfaceFit> surface;  // as seen from the camera's first place
  std::vector<SurfaceFit> places;     // from its further places, where one photograph did not hold the wall
  std::optional<Display> display;
  std::vector<ProjectorCalibration> projectors;
  std::map<std::string, std::string> steps;  // step name to a fingerprint of what it was computed from

  [[nodiscard]] const ProjectorCalibration* find(const std::string& name) const {
    for (const auto& projector : projectors) {
      if (projector.name == name) return &projector;
    }
    return nullptr;
  }
  bool operator==(const Calibration&) const = default;
};

}  // namespace pixelflex::calib
