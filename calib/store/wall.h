#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "devices/image/size.h"

namespace pixelflex::calib {

/// A marker on the wall whose place was measured by a person.
struct Fiducial {
  std::optional<int> aruco;                 // id in DICT_4X4_50
  std::optional<glm::dvec2> pointInCamera;  // pixel in the raw photograph; exactly one of the two is given
  glm::dvec2 pointInWall{0, 0};             // wall units
  bool operator==(const Fiducial&) const = default;
};

enum class SurfaceShape { kPlanar, kCamera, kCylinder };

struct Surface {
  SurfaceShape shape = SurfaceShape::kPlanar;
  double cylinderRadius = 0;  // wall units; only for kCylinder
  std::string units = "mm";
  std::vector<Fiducial> fiducials;
  /// Of wall coordinates: camera pixels where the wall is what the camera sees.
  [[nodiscard]] std::string wallUnits() const { return shape == SurfaceShape::kCamera ? "px" : units; }
  bool operator==(const Surface&) const = default;
};

/// Inner corners of the printed checkerboard and the side of a square in millimetres.
struct Checkerboard {
  int columns = 9;
  int rows = 6;
  double square = 30;
  bool operator==(const Checkerboard&) const = default;
};

enum class Transfer { kSrgb, kLinear };

struct CameraSource {
  std::string source = "photos";  // photos, sim, none, v4l2:DEVICE, aravis:NAME, gphoto2:NAME
  std::optional<Checkerboard> checkerboard;
  std::optional<double> latency;     // seconds that pictures take from here to the wall; none: as usual
  std::optional<Transfer> transfer;  // how photographs encode light; none: as was measured, else linear
  bool operator==(const CameraSource&) const = default;
};

enum class OutputKind { kNone, kSim, kMonitor, kDisplay };

/// Where a projector is plugged in.
struct Output {
  OutputKind kind = OutputKind::kNone;
  std::string monitor;  // kMonitor: RandR name, e.g. HDMI-1
  std::string display;  // kDisplay: X display, e.g. ":0"
  glm::ivec2 at{0, 0};  // kDisplay: top-left corner of the window on that display
  bool operator==(const Output&) const = default;
};

/// A controllable device's line.
struct DeviceLine {
  std::string driver;
  std::string at;                           // address, e.g. tcp://10.0.0.5:4352
  std::optional<std::string> passwordFile;  // its first line is the password; relative to the wall's folder
  bool operator==(const DeviceLine&) const = default;
};

struct ProjectorConfig {
  std::string name;
  devices::Size resolution;
  Output output;
  std::optional<std::string> gamma;  // path of 256 readings, relative to the wall's folder
  bool gammaByCamera = false;        // or the camera measures the response
  std::optional<DeviceLine> control;
  std::optional<DeviceLine> mirror;
  std::optional<glm::ivec2> flatAt;  // flat walls: the desktop pixel that this screen's top-left pixel shows
  bool operator==(const ProjectorConfig&) const = default;
};

/// What projectors that light the same part of the wall do with it: share its light, or show it to an eye each.
enum class StackRule { kShare, kLeftRight };

struct Blend {
  double densityExponent = 2;  // n of equation 7
  double priorityFeather = 0;  // denser projectors win, with a ramp of so many of their pixels; 0: equation 7 alone
  StackRule stack = StackRule::kShare;
  std::optional<double> uniformity;  // match the projectors' light, 0 brightest to 1 flattest; none: leave it as it is
  bool evenBlack = false;            // lift black where fewer projectors leak, for some contrast
  [[nodiscard]] bool matchesLight() const { return uniformity || evenBlack; }
  bool operator==(const Blend&) const = default;
};

struct AspectRatio {
  double width = 1;
  double height = 1;
  bool operator==(const AspectRatio&) const = default;
};

struct DisplayRequest {
  std::optional<AspectRatio> aspect;  // none: any
  int margin = 24;                    // desktop pixels kept clear of the union's edge
  bool operator==(const DisplayRequest&) const = default;
};

enum class DensityRule { kMean, kMax, kFixed };

/// How the desktop's pixels become a projector's.
enum class DesktopFilter { kCatmullRom, kBilinear, kNearest };

/// What the filter takes means of. Codes keep strokes of text as heavy as they look on a screen, black on white and
/// white on black; light keeps the brightness of fine patterns. The blend is made in light either way.
enum class FilterDomain { kSrgb, kLinear };

struct DesktopRequest {
  DensityRule density = DensityRule::kMean;
  double pixelsPerUnit = 0;   // kFixed: projector pixels per wall unit
  double oversampling = 1.0;  // projector pixels per desktop pixel
  DesktopFilter filter = DesktopFilter::kCatmullRom;
  FilterDomain filterDomain = FilterDomain::kSrgb;
  bool operator==(const DesktopRequest&) const = default;
};

/// wall.yaml: what there is, as a person wrote it.
struct Wall {
  Surface surface;
  CameraSource camera;
  std::vector<ProjectorConfig> projectors;
  Blend blend;
  DisplayRequest display;
  DesktopRequest desktop;
  Transfer transfer = Transfer::kSrgb;  // kLinear is the report's own behaviour: desktop codes taken as light
  std::optional<std::string> rig;       // simulated walls: the rig's file, relative to the wall's folder

  /// A wall of plain screens that needs no camera: every projector has flatAt.
  [[nodiscard]] bool isFlat() const {
    for (const auto& projector : projectors) {
      if (!projector.flatAt) return false;
    }
    return !projectors.empty();
  }
  bool operator==(const Wall&) const = default;
};

}  // namespace pixelflex::calib
