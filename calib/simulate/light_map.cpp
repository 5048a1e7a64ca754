#include "calib/simulate/light_map.h"

#include <algorithm>
#include <cmath>

#include "calib/simulate/parallel.h"

namespace pixelflex::calib {

namespace {

constexpr int kMargin = 12;  // raster pixels around the frame's image, for defocus and the point spread

/// Adds the image at a position in its own samples, linearly interpolated.
inline void addBilinear(const LightImage& image, float x, float y, float factor, float* sum) {
  if (!(x >= 0 && y >= 0 && x < static_cast<float>(image.width() - 1) && y < static_cast<float>(image.height() - 1)))
    return;
  const auto column = static_cast<int>(x);
  const auto row = static_cast<int>(y);
  const float right = x - static_cast<float>(column);
  const float below = (y - static_cast<float>(row)) * factor;
  const float above = factor - below;
  const std::ptrdiff_t stride = std::ptrdiff_t{image.width()} * LightImage::kChannels;
  const float* top = image.data() + row * stride + std::ptrdiff_t{column} * LightImage::kChannels;
  const float* bottom = top + stride;
  for (int c = 0; c < LightImage::kChannels; ++c) {
    const float first = top[c] + right * (top[c + LightImage::kChannels] - top[c]);
    const float second = bottom[c] + right * (bottom[c + LightImage::kChannels] - bottom[c]);
    sum[c] += above * first + below * second;
  }
}

}  // namespace

LightMap::LightMap(const RasterView& view, const ProjectorLight& light, double unit, int step) : step_(step) {
  findBox(view, light);
  if (box_.empty()) return;
  fillNodes(view, light, unit);
  chooseSamples();
}

void LightMap::findBox(const RasterView& view, const ProjectorLight& light) {
  constexpr int kGrid = 32;
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  const devices::Size frame = light.spec().resolution;
  for (int i = 0; i < (kGrid + 1) * (kGrid + 1); ++i) {
    const auto column = static_cast<double>(i % (kGrid + 1)) / kGrid;
    const auto row = static_cast<double>(i / (kGrid + 1)) / kGrid;
    const auto wall = light.wallFromPixel({frame.width * column, frame.height * row});
    const auto at = wall ? view.rasterFromWall(*wall) : std::nullopt;
    if (!at) continue;
    left = std::min(left, at->x), right = std::max(right, at->x);
    top = std::min(top, at->y), bottom = std::max(bottom, at->y);
  }
  const auto low = [](double value, int limit) {
    return static_cast<int>(std::clamp(std::floor(value) - kMargin, 0.0, double(limit)));
  };
  const auto high = [](double value, int limit) {
    return static_cast<int>(std::clamp(std::ceil(value) + kMargin, 0.0, double(limit)));
  };
  box_ = {low(left, view.size().width), low(top, view.size().height), high(right, view.size().width),
          high(bottom, view.size().height)};
}

void LightMap::fillNodes(const RasterView& view, const ProjectorLight& light, double unit) {
  columns_ = (box_.x1 - box_.x0 + step_ - 1) / step_ + 1;
  rows_ = (box_.y1 - box_.y0 + step_ - 1) / step_ + 1;
  nodes_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  const auto node = [&](int column, int row) -> Node {
    const glm::dvec2 at(box_.x0 + column * step_, box_.y0 + row * step_);
    const auto wall = view.wallFromRaster(at);
    const auto pixel = wall ? light.pixelFromWall(*wall) : std::nullopt;
    if (!pixel) return {};
    const double factor = light.illuminance(*wall) / unit * view.transmission(at);
    return {static_cast<float>(pixel->x), static_cast<float>(pixel->y), static_cast<float>(factor)};
  };
  inTwoHalves(rows_, [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      for (int column = 0; column < columns_; ++column) {
        nodes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] =
            node(column, row);
      }
    }
  });
  const auto width = static_cast<float>(light.spec().resolution.width);
  const auto height = static_cast<float>(light.spec().resolution.height);
  for (const Node& n : nodes_) {
    if (n.x >= 0 && n.y >= 0 && n.x <= width && n.y <= height) brightest_ = std::max(brightest_, double{n.factor});
  }
}

void LightMap::chooseSamples() {
  double stride = 0;  // projector pixels per raster pixel, at most
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    const Node& a = nodes_[i - 1];
    const Node& b = nodes_[i];
    if (i % static_cast<std::size_t>(columns_) == 0 || a.factor < 0 || b.factor < 0) continue;
    stride = std::max(stride, std::hypot(double{b.x - a.x}, double{b.y - a.y}) / step_);
  }
  samples_ = std::clamp(static_cast<int>(std::ceil(stride)), 2, 8);
}

std::vector<LightMap::Node> LightMap::nodesAt(float rowInLattice) const {
  const int above = std::clamp(static_cast<int>(rowInLattice), 0, rows_ - 2);
  const float part = rowInLattice - static_cast<float>(above);
  const Node* a = nodes_.data() + std::ptrdiff_t{above} * columns_;
  const Node* b = a + columns_;
  std::vector<Node> line(static_cast<std::size_t>(columns_));
  for (Node& node : line) {
    if (a->factor >= 0 && b->factor >= 0) {
      node = {a->x + part * (b->x - a->x), a->y + part * (b->y - a->y), a->factor + part * (b->factor - a->factor)};
    }
    ++a, ++b;
  }
  return line;
}

void LightMap::addSamples(const LightImage& image, const std::vector<Node>& nodes, float* out) const {
  const int perCell = step_ * samples_;
  const float offset = static_cast<float>(image.apron()) - 0.5F;  // from frame pixels to samples of the image
  const int pixels = box_.x1 - box_.x0;
  for (std::size_t cell = 0; cell + 1 < nodes.size(); ++cell) {
    const Node& a = nodes[cell];
    const Node& b = nodes[cell + 1];
    if (a.factor < 0 || b.factor < 0) continue;
    const float dx = b.x - a.x, dy = b.y - a.y, df = b.factor - a.factor;
    const int firstPixel = static_cast<int>(cell) * step_;
    const int last = std::min(perCell, (pixels - firstPixel) * samples_);
    for (int k = 0; k < last; ++k) {
      const float t = (static_cast<float>(k) + 0.5F) / static_cast<float>(perCell);
      float* sum = out + std::ptrdiff_t{firstPixel + k / samples_} * LightImage::kChannels;
      addBilinear(image, a.x + t * dx + offset, a.y + t * dy + offset, a.factor + t * df, sum);
    }
  }
}

void LightMap::renderRow(const LightImage& image, int y, float* out) const {
  const auto width = static_cast<std::size_t>(box_.x1 - box_.x0);
  std::vector<float> sums(width * LightImage::kChannels);
  for (int sub = 0; sub < samples_; ++sub) {
    const float at = static_cast<float>(y) + (static_cast<float>(sub) + 0.5F) / static_cast<float>(samples_);
    addSamples(image, nodesAt(at / static_cast<float>(step_)), sums.data());
  }
  const float share = 1.0F / static_cast<float>(samples_ * samples_);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t c = 0; c < 3; ++c) out[3 * x + c] = share * sums[LightImage::kChannels * x + c];
  }
}

devices::ImageF LightMap::render(const LightImage& image) const {
  if (box_.empty()) return {};
  devices::ImageF out(box_.size(), 3);
  inTwoHalves(out.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) renderRow(image, y, out.row(y).data());
  });
  return out;
}

}  // namespace pixelflex::calib
