#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pixelflex::calib {

/// Projector pixels per desktop pixel over a rectangle, sampled at the middles of columns x rows cells.
class HeatMap {
 public:
  using Density = std::function<std::optional<double>(glm::dvec2 point)>;
  HeatMap(glm::dvec2 low, glm::dvec2 high, int columns, const Density& density);

  /// The map's picture and its lines at 1 and 1.25, as SVG in the rectangle's coordinates. `line`: their width.
  [[nodiscard]] std::string svg(double line) const;

  [[nodiscard]] double least() const { return least_; }
  [[nodiscard]] double most() const { return most_; }
  [[nodiscard]] bool empty() const { return least_ > most_; }

 private:
  [[nodiscard]] std::optional<double> at(int column, int row) const {
    return values_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column)];
  }
  [[nodiscard]] glm::dvec2 middle(int column, int row) const;
  [[nodiscard]] std::string isoLine(double level) const;
  void addCell(int column, int row, double level, std::string& path) const;
  [[nodiscard]] std::string picture() const;

  glm::dvec2 low_;
  glm::dvec2 high_;
  int columns_;
  int rows_;
  std::vector<std::optional<double>> values_;
  double least_ = 1e300;
  double most_ = -1e300;
};

/// The colours' meaning as an SVG of its own.
[[nodiscard]] std::string heatLegend();

}  // namespace pixelflex::calib
