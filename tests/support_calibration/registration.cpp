#include "tests/support_calibration/registration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <optional>

namespace pixelflex::calib {
namespace {

constexpr int kStep = 3;  // every third pixel both ways is plenty and takes seconds

class Measurement {
 public:
  Measurement(const SimulatedWall& room, const Display& display, const std::vector<devices::ImageF>& shown)
      : room_(room), display_(display), shown_(shown) {}

  /// The wall place of the desktop point that a projector shows at a place of its frame, between its pixels linearly.
  [[nodiscard]] std::optional<glm::dvec2> meant(std::size_t projector, glm::dvec2 inProjector) const {
    const auto& image = shown_[projector];
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
    const glm::dvec2 far = glm::dvec2(display_.resolution.width, display_.resolution.height) - desktop;
    if (std::min(std::min(desktop.x, desktop.y), std::min(far.x, far.y)) < kReach) return std::nullopt;
    return glm::dvec2(display_.left + desktop.x / display_.resolution.width * (display_.right - display_.left),
                      display_.top + desktop.y / display_.resolution.height * (display_.bottom - display_.top));
  }

  /// Wall units: where the light lands minus where its desktop point should be.
  [[nodiscard]] std::optional<glm::dvec2> error(std::size_t projector, glm::dvec2 inProjector) const {
    const auto target = meant(projector, inProjector);
    const auto lands = room_.wallFromProjector(projector, inProjector);
    if (!target || !lands) return std::nullopt;
    return *lands - *target;
  }

  [[nodiscard]] double density(std::size_t projector, glm::dvec2 p) const {
    const auto a = room_.wallFromProjector(projector, p - glm::dvec2(0.5, 0));
    const auto b = room_.wallFromProjector(projector, p + glm::dvec2(0.5, 0));
    return 1 / glm::length(*b - *a);
  }

  void run(RegistrationFigures& figures) const {
    std::vector<double> all;
    std::vector<double> seams;
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      std::vector<double> own;
      for (int y = 0; y < shown_[i].height(); y += kStep) {
        for (int x = 0; x < shown_[i].width(); x += kStep) measurePixel(i, {x + 0.5, y + 0.5}, own, seams);
      }
      all.insert(all.end(), own.begin(), own.end());
      figures.registration.push_back(figuresOf(std::move(own)));
    }
    figures.all = figuresOf(std::move(all));
    figures.seam = figuresOf(std::move(seams));
  }

 private:
  void measurePixel(std::size_t i, glm::dvec2 p, std::vector<double>& own, std::vector<double>& seams) const {
    const auto mine = error(i, p);
    if (!mine) return;
    const double perUnit = density(i, p);
    own.push_back(glm::length(*mine) * perUnit);
    const auto inWall = room_.wallFromProjector(i, p);
    for (std::size_t j = i + 1; j < shown_.size(); ++j) {
      const auto inOther = room_.projectorFromWall(j, *inWall);
      if (!inOther) continue;
      if (const auto theirs = error(j, *inOther)) seams.push_back(glm::length(*mine - *theirs) * perUnit);
    }
  }

  const SimulatedWall& room_;
  const Display& display_;
  const std::vector<devices::ImageF>& shown_;
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

RegistrationFigures measureRegistration(const SimulatedWall& room, const Display& display,
                                        const std::vector<devices::ImageF>& shown) {
  RegistrationFigures figures;
  Measurement(room, display, shown).run(figures);
  return figures;
}

}  // namespace pixelflex::calib
