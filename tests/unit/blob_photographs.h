#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "calib/patterns/blob_decoder.h"
#include "calib/simulate/simulated_wall.h"

// One projector's photographs of the small rig, and ways to spoil them.

namespace pixelflex::calib {

using devices::Image8;

inline constexpr std::size_t kProjector = 0;

/// The small rig, its camera's lens left as it is: the decoder gets no camera model, and the truth is raw pixels.
inline SimulatedWall& room() {
  static SimulatedWall wall(loadRig(std::string(PIXELFLEX_SOURCE_DIR) + "/config/rigs/mini-2.yaml"));
  return wall;
}

inline const BlobLayout& layout() {
  static const BlobLayout kLayout(room().rig().projectors[kProjector].resolution);
  return kLayout;
}

inline PatternPhotos photograph(std::size_t projector) {
  PatternPhotos photos;
  EXPECT_TRUE(room().person().arrange(devices::Scene::kDark, 0));
  for (const Pattern pattern : allPatterns()) {
    room().projector(projector).show(renderPattern(pattern, layout()));
    photos[indexOf(pattern)] = room().camera().shoot();
  }
  room().projector(projector).blank();
  return photos;
}

inline const PatternPhotos& good() {
  static const PatternPhotos kPhotos = photograph(kProjector);
  return kPhotos;
}
inline const PatternPhotos& ofTheOther() {
  static const PatternPhotos kPhotos = photograph(1);
  return kPhotos;
}

inline DecodedBlobs decode(const PatternPhotos& photos) {
  return decodeBlobs(photos, layout(), CameraMapping());
}

/// Root mean square distance from the truth, projector pixels.
inline double errorOf(const DecodedBlobs& decoded) {
  double sum = 0;
  for (const auto& blob : decoded.blobs) {
    const auto truth = room().cameraFromWall(*room().wallFromProjector(kProjector, layout().centre(blob.id)));
    const double error = glm::length(blob.pointInUndistorted - truth.value()) / decoded.cameraScale;
    sum += error * error;
  }
  return std::sqrt(sum / std::max<double>(1, double(decoded.blobs.size())));
}

inline Image8& at(PatternPhotos& photos, Pattern pattern) {
  return photos[indexOf(pattern)];
}

/// `to` gets x, y and a code, and gives another.
template <class To>
void change(Image8& photo, const To& to) {
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const double code = to(x, y, photo.at(x, y, c));
        photo.at(x, y, c) = static_cast<std::uint8_t>(std::clamp(std::lround(code), 0L, 255L));
      }
    }
  }
}

/// A Gaussian of this sigma, by its two passes.
inline void blur(Image8& photo, double sigma) {
  const int reach = static_cast<int>(3 * sigma) + 1;
  std::vector<double> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) sum += weights.emplace_back(std::exp(-i * i / (2 * sigma * sigma)));
  for (const bool across : {true, false}) {
    const Image8 from = photo;
    for (int y = 0; y < photo.height(); ++y) {
      for (int x = 0; x < photo.width(); ++x) {
        for (int c = 0; c < 3; ++c) {
          double light = 0;
          for (int i = -reach; i <= reach; ++i) {
            const int u = std::clamp(across ? x + i : x, 0, photo.width() - 1);
            const int v = std::clamp(across ? y : y + i, 0, photo.height() - 1);
            light += weights[static_cast<std::size_t>(i + reach)] * from.at(u, v, c);
          }
          photo.at(x, y, c) = static_cast<std::uint8_t>(std::lround(light / sum));
        }
      }
    }
  }
}

/// Whole pixels: nothing is interpolated.
inline void shift(Image8& photo, int dx, int dy) {
  const Image8 from = photo;
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      const int u = std::clamp(x - dx, 0, photo.width() - 1);
      const int v = std::clamp(y - dy, 0, photo.height() - 1);
      for (int c = 0; c < 3; ++c) photo.at(x, y, c) = from.at(u, v, c);
    }
  }
}

/// Something dark in front of part of the wall.
inline void hide(Image8& photo, int left, int top, int right, int bottom) {
  change(photo,
         [=](int x, int y, double code) { return x >= left && x < right && y >= top && y < bottom ? 1.0 : code; });
}

/// One problem of exactly these photographs, and these words in it.
inline void expectProblem(const DecodedBlobs& decoded, const std::vector<Pattern>& patterns, const std::string& words,
                          bool fatal) {
  ASSERT_FALSE(decoded.problems.empty());
  const PhotoProblem& first = decoded.problems.front();
  EXPECT_EQ(first.patterns, patterns) << first.seen;
  EXPECT_THAT(first.seen, ::testing::HasSubstr(words));
  EXPECT_FALSE(first.advice.empty());
  EXPECT_EQ(first.fatal, fatal) << first.seen;
  EXPECT_EQ(decoded.unusable(), fatal);
}

}  // namespace pixelflex::calib
