#include "tests/accuracy/report_pipeline.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <map>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "calib/geometry/homography.h"
#include "calib/patterns/blob_pattern.h"
#include "devices/image/png_file.h"

namespace pixelflex::calib {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<glm::dvec2, Kernel>;  // info: the place on the wall
using Mesh = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;

constexpr double kThreshold = 0.25;  // of the brightest pixel
constexpr std::size_t kFewestBlobs = 50;

/// OpenCV's matrix: pixel centres on whole numbers, the store has them at +0.5.
cv::Matx33d matrixOf(const CameraIntrinsics& camera) {
  return {camera.fx, 0, camera.cx - 0.5, 0, camera.fy, camera.cy - 0.5, 0, 0, 1};
}

/// A photograph in grey without the lens's distortion.
cv::Mat undistorted(const std::filesystem::path& file, const CameraIntrinsics& camera) {
  devices::Image8 photo = devices::readPng8(file);
  const cv::Mat rgb(photo.height(), photo.width(), CV_8UC3, photo.samples().data());
  cv::Mat grey;
  cv::transform(rgb, grey, cv::Matx13f(1 / 3.F, 1 / 3.F, 1 / 3.F));
  grey.convertTo(grey, CV_32F);
  const cv::Vec<double, 5> lens(camera.radial[0], camera.radial[1], camera.tangential[0], camera.tangential[1],
                                camera.radial[2]);
  cv::Mat straight;
  cv::undistort(grey, straight, matrixOf(camera), lens);
  return straight;
}

struct Centre {
  cv::Point2d at;  // OpenCV's coordinates
  int id = 0;
};

/// Weighted centres of all spots brighter than the threshold.
std::vector<Centre> centresIn(const cv::Mat& photo) {
  double brightest = 0;
  cv::minMaxLoc(photo, nullptr, &brightest);
  const double threshold = kThreshold * brightest;
  cv::Mat labels;
  const int count = cv::connectedComponents(photo > threshold, labels, 8);
  std::vector<cv::Vec4d> sums(static_cast<std::size_t>(count));  // light, light * x, light * y, pixels
  for (int y = 0; y < photo.rows; ++y) {
    for (int x = 0; x < photo.cols; ++x) {
      const int label = labels.at<int>(y, x);
      if (label == 0) continue;
      const double light = photo.at<float>(y, x);
      sums[static_cast<std::size_t>(label)] += cv::Vec4d(light, light * x, light * y, 1);
    }
  }
  std::vector<Centre> centres;
  for (const auto& sum : sums) {
    if (sum[3] >= 4) centres.push_back({{sum[1] / sum[0], sum[2] / sum[0]}});
  }
  return centres;
}

std::filesystem::path photoOf(const std::filesystem::path& folder, Pattern pattern, const BlobLayout& layout) {
  return folder / (projected(pattern, layout).name + ".png");
}

/// The size of blobs that was shown.
BlobLayout layoutOf(const std::filesystem::path& folder, devices::Size resolution) {
  for (const BlobSize size : {BlobSize::kFine, BlobSize::kCoarse}) {
    const BlobLayout layout(resolution, size);
    if (std::filesystem::exists(photoOf(folder, Pattern::kBlobs, layout))) return layout;
  }
  return BlobLayout(resolution);
}

/// Seven photographs, the least significant bit first.
void readIds(std::vector<Centre>& centres, const cv::Mat& all, const std::filesystem::path& folder,
             const BlobLayout& layout, const CameraIntrinsics& camera) {
  for (int bit = 0; bit < kCodeBits; ++bit) {
    const cv::Mat photo =
        undistorted(photoOf(folder, static_cast<Pattern>(static_cast<int>(Pattern::kBit0) + bit), layout), camera);
    for (auto& centre : centres) {
      const cv::Point at(cvRound(centre.at.x), cvRound(centre.at.y));
      if (photo.at<float>(at) > 0.5F * all.at<float>(at)) centre.id |= 1 << bit;
    }
  }
}

std::map<int, glm::dvec2> blobsOf(const std::filesystem::path& folder, const BlobLayout& layout,
                                  const CameraIntrinsics& camera) {
  const cv::Mat all = undistorted(photoOf(folder, Pattern::kBlobs, layout), camera);
  auto centres = centresIn(all);
  readIds(centres, all, folder, layout, camera);
  std::map<int, glm::dvec2> blobs;
  for (const auto& centre : centres) {
    if (centre.id >= 1 && centre.id <= kBlobCount) blobs[centre.id] = {centre.at.x + 0.5, centre.at.y + 0.5};
  }
  if (blobs.size() < kFewestBlobs) {
    throw std::runtime_error(folder.string() + ": the report's pipeline finds only " + std::to_string(blobs.size()) +
                             " blobs");
  }
  return blobs;
}

Mesh meshOf(const std::map<int, glm::dvec2>& blobs, const BlobLayout& layout, const Homography& wallFromCamera) {
  Mesh mesh;
  for (const auto& [id, blob] : blobs) {
    const glm::dvec2 centre = layout.centre(id);
    mesh.insert(Kernel::Point_2(centre.x, centre.y))->info() = wallFromCamera.map(blob);
  }
  return mesh;
}

/// Texture coordinates are affine within each triangle.
std::optional<glm::dvec2> placeIn(const Mesh& mesh, glm::dvec2 p) {
  const Kernel::Point_2 at(p.x, p.y);
  const auto face = mesh.locate(at);
  if (face == nullptr || mesh.is_infinite(face)) return std::nullopt;
  const auto part = [&](int i) {
    const auto& a = face->vertex((i + 1) % 3)->point();
    const auto& b = face->vertex((i + 2) % 3)->point();
    return CGAL::area(a, b, at) * face->vertex(i)->info();
  };
  const double whole = CGAL::area(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
  return (part(0) + part(1) + part(2)) / whole;
}

}  // namespace

MeantPlace meantByReportPipeline(const std::filesystem::path& captures, const Calibration& calibration) {
  const Homography wallFromCamera(calibration.surface->wallFromCamera);
  auto meshes = std::make_shared<std::vector<Mesh>>();
  for (const auto& projector : calibration.projectors) {
    const BlobLayout layout = layoutOf(captures / projector.name, projector.resolution);
    const auto blobs = blobsOf(captures / projector.name, layout, *calibration.camera);
    meshes->push_back(meshOf(blobs, layout, wallFromCamera));
  }
  return [meshes](std::size_t projector, glm::dvec2 p) { return placeIn(meshes->at(projector), p); };
}

}  // namespace pixelflex::calib
