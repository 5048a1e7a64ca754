#include "tests/gl/plans.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "viewer/tiles/tile_layout.h"

namespace pixelflex::testing {
namespace {

struct Corner {
  glm::dvec2 inProjector;
  glm::dvec3 weighted;
};

/// Where the edge crosses the plane, the same number from whichever end the edge is walked.
Corner crossing(const Corner& p, const Corner& q, glm::dvec3 plane) {
  const bool swap = std::pair(q.inProjector.x, q.inProjector.y) < std::pair(p.inProjector.x, p.inProjector.y);
  const auto& from = swap ? q : p;
  const auto& to = swap ? p : q;
  const double a = glm::dot(plane, from.weighted);
  const double t = a / (a - glm::dot(plane, to.weighted));
  return {from.inProjector + t * (to.inProjector - from.inProjector),
          from.weighted + t * (to.weighted - from.weighted)};
}

std::vector<Corner> keep(const std::vector<Corner>& polygon, glm::dvec3 plane) {
  std::vector<Corner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& p = polygon[i];
    const auto& q = polygon[(i + 1) % polygon.size()];
    const bool pIn = glm::dot(plane, p.weighted) >= 0;
    const bool qIn = glm::dot(plane, q.weighted) >= 0;
    if (pIn) kept.push_back(p);
    if (pIn != qIn) kept.push_back(crossing(p, q, plane));
  }
  return kept;
}

std::vector<Corner> partIn(const reference::Triangle& triangle, const viewer::Box& box) {
  std::vector<Corner> polygon;
  for (std::size_t i = 0; i < 3; ++i) polygon.push_back({triangle.inProjector[i], triangle.weighted[i]});
  polygon = keep(polygon, {1, 0, -box.left});
  polygon = keep(polygon, {-1, 0, box.right});
  polygon = keep(polygon, {0, 1, -box.top});
  return keep(polygon, {0, -1, box.bottom});
}

void addPolygon(viewer::WarpMesh& mesh, const std::vector<Corner>& polygon) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& corner : polygon) {
    mesh.vertices.push_back({static_cast<float>(corner.inProjector.x), static_cast<float>(corner.inProjector.y),
                             static_cast<float>(corner.weighted.x), static_cast<float>(corner.weighted.y),
                             static_cast<float>(corner.weighted.z)});
  }
  for (std::uint32_t i = 2; i < polygon.size(); ++i) {
    for (const auto index : {first, first + i - 1, first + i}) mesh.indices.push_back(index);
  }
}

}  // namespace

WeightedMap identityMap(glm::dvec2 shift) {
  return [shift](glm::dvec2 p) { return glm::dvec3(p + shift, 1); };
}

WeightedMap affineMap(devices::Size resolution, devices::Size desktop) {
  return [=](glm::dvec2 p) {
    const glm::dvec2 centred = p - glm::dvec2(resolution.width, resolution.height) / 2.0;
    const double scale = 0.8 * desktop.width / resolution.width;
    const glm::dvec2 turned(std::cos(0.12) * centred.x - std::sin(0.12) * centred.y,
                            std::sin(0.12) * centred.x + std::cos(0.12) * centred.y);
    return glm::dvec3(scale * turned + glm::dvec2(desktop.width, desktop.height) / 2.0, 1);
  };
}

WeightedMap homographyMap(devices::Size resolution, devices::Size desktop) {
  const auto affine = affineMap(resolution, desktop);
  return [=](glm::dvec2 p) {
    const auto at = affine(p);
    const double w = 1 + 0.18 * (p.x / resolution.width - 0.5) - 0.11 * (p.y / resolution.height - 0.5);
    return glm::dvec3(at.x, at.y, w);
  };
}

WeightedMap bentMap(devices::Size resolution, devices::Size desktop) {
  const auto keystone = homographyMap(resolution, desktop);
  return [=](glm::dvec2 p) {
    const glm::dvec2 middle = glm::dvec2(resolution.width, resolution.height) / 2.0;
    const glm::dvec2 ray = (p - middle) / middle.x;
    return keystone(middle + middle.x * ray * (1 - 0.06 * glm::dot(ray, ray)));
  };
}

std::vector<reference::Triangle> gridOf(const WeightedMap& map, devices::Size resolution, int columns, int rows) {
  const auto corner = [&](int i, int j) {
    const glm::dvec2 p(static_cast<double>(resolution.width) * i / columns,
                       static_cast<double>(resolution.height) * j / rows);
    return Corner{p, map(p)};
  };
  std::vector<reference::Triangle> triangles;
  const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
    triangles.push_back({{a.inProjector, b.inProjector, c.inProjector}, {a.weighted, b.weighted, c.weighted}});
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      add(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
      add(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
    }
  }
  return triangles;
}

viewer::WarpMesh meshOf(const std::vector<reference::Triangle>& triangles, devices::Size desktop) {
  const viewer::TileLayout layout(desktop);
  viewer::WarpMesh mesh;
  for (int layer = 0; layer < layout.count(); ++layer) {
    const auto first = static_cast<std::uint32_t>(mesh.indices.size());
    for (const auto& triangle : triangles) addPolygon(mesh, partIn(triangle, layout.patch(layer)));
    const auto count = static_cast<std::uint32_t>(mesh.indices.size()) - first;
    if (count > 0) mesh.patches.push_back({layer, first, count});
  }
  return mesh;
}

viewer::OutputPlan planOf(const std::string& name, const WeightedMap& map, devices::Size resolution,
                          devices::Size desktop, int columns, int rows) {
  viewer::OutputPlan plan;
  plan.name = name;
  plan.resolution = resolution;
  plan.desktop = desktop;
  plan.mesh = meshOf(gridOf(map, resolution, columns, rows), desktop);
  return plan;
}

devices::Image8 testDesktop(devices::Size size, std::uint32_t seed) {
  devices::Image8 image(size, 3);
  std::minstd_rand random(seed);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool line = (x + static_cast<int>(seed)) % 37 == 0 || y % 29 == 0;
      const int noise = static_cast<int>(random() % 64);
      image.at(x, y, 0) = static_cast<std::uint8_t>(line ? 255 : (x * 3 + noise) % 256);
      image.at(x, y, 1) = static_cast<std::uint8_t>(line ? 255 : 96 + noise + 60 * ((x / 16 + y / 16) % 2));
      image.at(x, y, 2) = static_cast<std::uint8_t>(line ? 0 : (x + y * 2) / 4 % 256);
    }
  }
  return image;
}

viewer::Batch batchOf(const devices::Image8& desktop, const std::vector<viewer::Box>& boxes) {
  viewer::Batch batch;
  batch.desktop = desktop.size();
  batch.boxes = boxes;
  batch.completesUpdate = true;
  for (const auto& box : boxes) {
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        const bool inside = x >= 0 && y >= 0 && x < desktop.width() && y < desktop.height();
        for (int c = 0; c < 3; ++c) batch.pixels.push_back(std::byte{inside ? desktop.at(x, y, c) : std::uint8_t{77}});
        batch.pixels.push_back(std::byte{0x5A});  // undefined: must not be seen anywhere
      }
    }
  }
  return batch;
}

viewer::Batch wholeBatch(const devices::Image8& desktop) {
  return batchOf(desktop, {viewer::boxOf(desktop.size())});
}

}  // namespace pixelflex::testing
