#include "tests/support_calibration/registration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>

namespace pixelflex::calib {
namespace {

constexpr int kStep = 3;  // every third pixel both ways is plenty and takes seconds

/// The wall place of the desktop point that a picture shows at a place of its frame, between its pixels linearly.
std::optional<glm::dvec2> placeInPicture(const Display& display, const devices::ImageF& image, glm::dvec2 inProjector) {
  if (image.empty()) return std::nullopt;
  const glm::dvec2 p = inProjector - 0.5;
  const int x = static_cast<int>(std::floor(p.x));
  const int y = static_cast<int>(std::floor(p.y));
  if (x < 0 || y < 0 || x + 1 >= image.width() || y + 1 >= image.height()) return std::nullopt;
  const glm::dvec2 f = p - glm::dvec2(x, y);
  // Within the filter's reach of its border a desktop of coordinates is not linear any more.
  constexpr double kReach = 2;
  glm::dvec2 desktop{0, 0};
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      if (image.at(x + dx, y + dy, 3) < 0.5F) return std::nullopt;
      const double weight = (dx == 1 ? f.x : 1 - f.x) * (dy == 1 ? f.y : 1 - f.y);
      desktop += weight * glm::dvec2(image.at(x + dx, y + dy, 0), image.at(x + dx, y + dy, 1));
    }
  }
  const glm::dvec2 far = glm::dvec2(display.resolution.width, display.resolution.height) - desktop;
  if (std::min(std::min(desktop.x, desktop.y), std::min(far.x, far.y)) < kReach) return std::nullopt;
  return glm::dvec2(display.left + desktop.x / display.resolution.width * (display.right - display.left),
                    display.top + desktop.y / display.resolution.height * (display.bottom - display.top));
}

class Measurement {
 public:
  Measurement(const SimulatedWall& room, const MeantPlace& meant, std::optional<std::size_t> unit)
      : room_(room), meant_(meant), unit_(unit) {}

  void run(RegistrationFigures& figures) const {
    std::vector<double> all;
    std::vector<double> seams;
    for (std::size_t i = 0; i < room_.projectorCount(); ++i) {
      const devices::Size size = room_.rig().projectors[i].resolution;
      std::vector<double> own;
      for (int y = 0; y < size.height; y += kStep) {
        for (int x = 0; x < size.width; x += kStep) measurePixel(i, {x + 0.5, y + 0.5}, own, seams);
      }
      all.insert(all.end(), own.begin(), own.end());
      figures.registration.push_back(figuresOf(std::move(own)));
    }
    figures.all = figuresOf(std::move(all));
    figures.seam = figuresOf(std::move(seams));
  }

 private:
  /// Wall units: where the light lands minus where its desktop point should be.
  [[nodiscard]] std::optional<glm::dvec2> error(std::size_t projector, glm::dvec2 inProjector) const {
    const auto target = meant_(projector, inProjector);
    const auto lands = target ? room_.wallFromProjector(projector, inProjector) : std::nullopt;
    if (!lands) return std::nullopt;
    return *lands - *target;
  }

  /// Pixels per wall unit of the projector whose pixels are counted.
  [[nodiscard]] std::optional<double> density(std::size_t projector, glm::dvec2 p, glm::dvec2 inWall) const {
    const auto there = unit_ ? room_.projectorFromWall(*unit_, inWall) : p;
    if (!there) return std::nullopt;
    const auto a = room_.wallFromProjector(unit_.value_or(projector), *there - glm::dvec2(0.5, 0));
    const auto b = room_.wallFromProjector(unit_.value_or(projector), *there + glm::dvec2(0.5, 0));
    if (!a || !b) return std::nullopt;
    return 1 / glm::length(*b - *a);
  }

  void measurePixel(std::size_t i, glm::dvec2 p, std::vector<double>& own, std::vector<double>& seams) const {
    const auto mine = error(i, p);
    if (!mine) return;
    const auto inWall = room_.wallFromProjector(i, p);
    const auto perUnit = density(i, p, *inWall);
    if (!perUnit) return;
    own.push_back(glm::length(*mine) * *perUnit);
    for (std::size_t j = i + 1; j < room_.projectorCount(); ++j) {
      const auto inOther = room_.projectorFromWall(j, *inWall);
      if (!inOther) continue;
      if (const auto theirs = error(j, *inOther)) seams.push_back(glm::length(*mine - *theirs) * *perUnit);
    }
  }

  const SimulatedWall& room_;
  const MeantPlace& meant_;
  std::optional<std::size_t> unit_;
};

}  // namespace

ErrorFigures figuresOf(std::vector<double> errors) {
  ErrorFigures figures{.count = errors.size()};
  if (errors.empty()) return figures;
  std::ranges::sort(errors);
  double squares = 0;
  for (const double error : errors) squares += error * error;
  figures.rms = std::sqrt(squares / static_cast<double>(errors.size()));
  figures.p95 = errors[static_cast<std::size_t>(0.95 * static_cast<double>(errors.size() - 1))];
  figures.maximum = errors.back();
  return figures;
}

std::string text(const ErrorFigures& figures) {
  char line[128];
  std::snprintf(line, sizeof line, "rms %.4f  p95 %.4f  max %.4f px  (%zu points)", figures.rms, figures.p95,
                figures.maximum, figures.count);
  return line;
}

RegistrationFigures measureRegistration(const SimulatedWall& room, const MeantPlace& meant,
                                        std::optional<std::size_t> unit) {
  RegistrationFigures figures;
  Measurement(room, meant, unit).run(figures);
  return figures;
}

MeantPlace meantByPictures(const Display& display, const std::vector<devices::ImageF>& shown) {
  return [display, &shown](std::size_t projector, glm::dvec2 pointInProjector) {
    return placeInPicture(display, shown[projector], pointInProjector);
  };
}

}  // namespace pixelflex::calib
