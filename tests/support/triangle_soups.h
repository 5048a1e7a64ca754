#pragma once

#include <glm/vec2.hpp>

#include "viewer/model/triangle_soup.h"

namespace pixelflex::testing {

/// One triangle in each unit square of a square lattice, that much wide and high, towards +z.
inline viewer::TriangleSoup triangleLattice(int side) {
  viewer::TriangleSoup soup;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
        soup.push_back(
            {.position = {static_cast<float>(x) + corner.x, static_cast<float>(y) + corner.y, 0}, .normal = {0, 0, 1}});
      }
    }
  }
  return soup;
}

/// An upright square towards +z around (0, 0, z), the picture over all of it.
inline viewer::TriangleSoup sheetAt(float z, float half) {
  viewer::TriangleSoup soup;
  for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
    soup.push_back({.position = glm::vec3((2.0F * corner - 1.0F) * half, z),
                    .normal = {0, 0, 1},
                    .texture = glm::vec2(corner.x, 1 - corner.y)});
  }
  return soup;
}

/// A scene of one material.
inline viewer::Scene sceneOf(const viewer::TriangleSoup& soup, const viewer::Material& material = {}) {
  viewer::Scene scene;
  scene.materials.push_back(material);
  addToScene(soup, 0, scene);
  return scene;
}

}  // namespace pixelflex::testing
