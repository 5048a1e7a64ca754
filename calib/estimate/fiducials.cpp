#include "calib/estimate/fiducials.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calib/estimate/fiducial_fit.h"
#include "calib/estimate/intrinsics.h"

namespace pixelflex::calib {
namespace {

constexpr double kLeastAgreement = 0.8;  // of a picture with the marker that it seems to be

struct Candidate {
  int id = 0;
  std::array<glm::dvec2, 4> corners{};  // raw pixels, from the marker's top left, clockwise
};

struct Found {
  int id = 0;
  glm::dvec2 centre{0, 0};  // undistorted
  glm::dvec2 pointInRaw{0, 0};
  double side = 0;
  double agreement = 0;
};

class MarkerSearch {
 public:
  MarkerSearch(const devices::Image8& photo, const CameraMapping& camera, const std::set<int>& wanted)
      : grey_(photo.size(), 1),
        camera_(camera),
        wanted_(wanted),
        dictionary_(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50)) {
    // OpenCV reads only: the cast drops a const that cv::Mat cannot express.
    const cv::Mat rgb(photo.height(), photo.width(), CV_8UC3, const_cast<std::uint8_t*>(photo.samples().data()));
    cv::cvtColor(rgb, view(), cv::COLOR_RGB2GRAY);
  }

  std::vector<Found> run() {
    look(view(), 1, {0, 0}, 0.03);
    if (!complete()) look(view(), 1, {0, 0}, 0.08);
    // Small modules run into each other; enlarged, their outline is found.
    if (!complete()) {
      cv::Mat larger;
      cv::resize(view(), larger, {}, 2, 2, cv::INTER_CUBIC);
      look(larger, 2, {0, 0}, 0.05);
    }
    return found_;
  }

 private:
  [[nodiscard]] cv::Mat view() { return {grey_.height(), grey_.width(), CV_8UC1, grey_.samples().data()}; }

  [[nodiscard]] bool complete() const {
    if (wanted_.empty()) return false;
    return std::ranges::all_of(wanted_,
                               [&](int id) { return std::ranges::find(found_, id, &Found::id) != found_.end(); });
  }

  void look(const cv::Mat& picture, double scale, glm::dvec2 origin, double roundness) {
    const auto parameters = cv::aruco::DetectorParameters::create();
    parameters->minMarkerPerimeterRate = 40 * scale / std::max(picture.cols, picture.rows);
    parameters->polygonalApproxAccuracyRate = roundness;
    parameters->perspectiveRemovePixelPerCell = 8;
    parameters->minCornerDistanceRate = 0.02;
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(picture, dictionary_, corners, ids, parameters);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      Candidate candidate{ids[i], {}};
      for (std::size_t k = 0; k < 4; ++k) {
        candidate.corners[k] = origin + glm::dvec2(corners[i][k].x + 0.5, corners[i][k].y + 0.5) / scale;
      }
      accept(candidate);
    }
  }

  void accept(const Candidate& candidate) {
    if (!wanted_.empty() && !wanted_.contains(candidate.id)) return;
    const auto fit = fitMarker(grey_, camera_, modulesOf(candidate.id), candidate.corners);
    if (!fit || fit->agreement < kLeastAgreement) return;
    const double side = glm::length(fit->corners[1] - fit->corners[0]) + glm::length(fit->corners[2] - fit->corners[1]);
    const Found marker{candidate.id, fit->centre, camera_.rawFromUndistorted(fit->centre), side / 2, fit->agreement};
    for (const auto& known : found_) {
      if (known.id == marker.id && glm::length(known.centre - marker.centre) < 0.5 * known.side) return;
    }
    found_.push_back(marker);
  }

  [[nodiscard]] MarkerModules modulesOf(int id) const {
    const cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(dictionary_->bytesList.rowRange(id, id + 1), 4);
    MarkerModules modules{};
    std::size_t next = 0;
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) modules[next++] = bits.at<std::uint8_t>(y, x) != 0;
    }
    return modules;
  }

  devices::Image8 grey_;
  const CameraMapping& camera_;
  const std::set<int>& wanted_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  std::vector<Found> found_;
};

std::string pixelText(glm::dvec2 p) {
  return "(" + std::to_string(std::lround(p.x)) + ", " + std::to_string(std::lround(p.y)) + ")";
}

}  // namespace

std::map<int, glm::dvec2> findMarkers(const devices::Image8& photo, const CameraMapping& camera,
                                      const std::set<int>& wanted) {
  std::map<int, Found> markers;
  for (const auto& marker : MarkerSearch(photo, camera, wanted).run()) {
    const auto [known, first] = markers.emplace(marker.id, marker);
    if (first) continue;
    throw EstimateError("marker " + std::to_string(marker.id) + " is seen twice, at pixel " +
                        pixelText(known->second.pointInRaw) + " and at " + pixelText(marker.pointInRaw) +
                        ": take one of them away or cover it");
  }
  std::map<int, glm::dvec2> centres;
  for (const auto& [id, marker] : markers) centres[id] = marker.centre;
  return centres;
}

}  // namespace pixelflex::calib
