// One pass against a ray caster that shares nothing with it: which of several interpenetrating triangles is in front at
// every pixel of unlike projectors.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <iostream>
#include <optional>

#include "devices/display/gl_context.h"
#include "tests/support/triangle_soups.h"
#include "viewer/model/model_renderer.h"

namespace pixelflex::viewer {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

const WallWindow kWindow{{1600, 900}};
const glm::dvec3 kEye(150, -80, 1500);

/// A fan of sheets through each other, some of which reach through the window and some around the eye.
std::vector<Triangle> sheets() {
  std::vector<Triangle> all;
  for (int i = 0; i < 9; ++i) {
    const double a = 0.7 * i;
    const glm::dvec3 along(std::cos(a) * 900, std::sin(a * 1.3) * 600, std::sin(a) * 500);
    const glm::dvec3 across(-std::sin(a) * 500, std::cos(a * 0.7) * 700, std::cos(a) * 400);
    const glm::dvec3 middle(60.0 * (i - 4), 25.0 * (i % 3), -40.0 * i);
    all.push_back({middle - along - across, middle + along - across, middle + across});
  }
  return all;
}

Scene sceneOf(const std::vector<Triangle>& triangles) {
  TriangleSoup soup;
  for (const auto& triangle : triangles) {
    for (const auto& corner : triangle) soup.push_back({.position = corner, .normal = {0, 0, 1}});
  }
  return testing::sceneOf(soup);
}

/// Along the ray, as a multiple of it.
std::optional<double> hit(const Triangle& triangle, glm::dvec3 origin, glm::dvec3 ray) {
  const glm::dvec3 u = triangle[1] - triangle[0];
  const glm::dvec3 v = triangle[2] - triangle[0];
  const glm::dvec3 p = glm::cross(ray, v);
  const double determinant = glm::dot(u, p);
  if (std::abs(determinant) < 1e-9) return std::nullopt;
  const glm::dvec3 s = origin - triangle[0];
  const double a = glm::dot(s, p) / determinant;
  const glm::dvec3 q = glm::cross(s, u);
  const double b = glm::dot(ray, q) / determinant;
  if (a < 0 || b < 0 || a + b > 1) return std::nullopt;
  const double t = glm::dot(v, q) / determinant;
  return t > 0 ? std::optional(t) : std::nullopt;
}

/// What the eye sees at a place of the window.
std::optional<glm::dvec3> seen(const std::vector<Triangle>& triangles, glm::dvec2 inWindow) {
  const glm::dvec3 ray = glm::dvec3(inWindow, 0) - kEye;
  std::optional<double> nearest;
  for (const auto& triangle : triangles) {
    const auto t = hit(triangle, kEye, ray);
    if (t && *t * glm::length(ray) > 200 && (!nearest || *t < *nearest)) nearest = t;
  }
  return nearest ? std::optional(kEye + *nearest * ray) : std::nullopt;
}

/// Placed so that the model's coordinates are the window's.
ModelView viewOf(const Bounds3& bounds) {
  ModelView view{.window = kWindow, .viewer = {.eye = kEye}};
  view.pose.zoom = 1;
  const double radius = radiusInWindow(view.pose, bounds, kWindow);
  view.pose.zoom = 0.5 * glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low)) / radius;
  view.pose.shift = glm::dvec3(bounds.middle()) / 900.0;
  return view;
}

/// A keystone: projector clip coordinates from the desktop's.
const std::array<glm::dmat3, 3> kKeystones{{
    glm::dmat3(1),
    {{2.4, 0.1, 0.22}, {-0.15, 2.2, -0.12}, {1.1, 0.3, 1}},
    {{-1.9, 0.2, 0.30}, {0.1, 2.6, 0.25}, {0.7, -0.9, -1.3}},
}};

TEST(ModelDepth, IsThatOfARayCasterOnEveryProjector) {
  const auto triangles = sheets();
  std::vector<ModelOutput> outputs;
  constexpr int kWidth = 240;
  constexpr int kHeight = 180;
  for (const auto& keystone : kKeystones) {
    ModelOutput output{.light = {.name = "p", .resolution = {kWidth, kHeight}}};
    output.projectorFromDesktop = depthKeeping(keystone);
    outputs.push_back(output);
  }
  devices::HeadlessContext context;
  const devices::GlDebugLog log;
  ModelRenderer renderer(context, outputs, {.measure = true});
  renderer.setScene(sceneOf(triangles));
  renderer.setView(viewOf(renderer.bounds()));
  renderer.draw();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto frame = renderer.readOutputFloat(i);
    const glm::dmat3 desktopFromProjector = glm::inverse(kKeystones[i]);
    int compared = 0;
    int different = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::dvec2 clip = clipFromPixel({x + 0.5, y + 0.5}, {kWidth, kHeight});
        const glm::dvec3 h = desktopFromProjector * glm::dvec3(clip, 1);
        const glm::dvec2 desktop = glm::dvec2(h) / h.z;
        const bool inside = std::abs(desktop.x) < 1 && std::abs(desktop.y) < 1;
        const auto expected =
            inside ? seen(triangles, 0.5 * kWindow.extent * glm::dvec2(desktop.x, -desktop.y)) : std::nullopt;
        const bool shown = frame.at(x, y, 3) > 0.5F;
        ++compared;
        if (shown != expected.has_value()) {
          ++different;
        } else if (shown) {
          const glm::dvec3 there(frame.at(x, y, 0), frame.at(x, y, 1), frame.at(x, y, 2));
          different += glm::distance(there, *expected) > 1.0 ? 1 : 0;
        }
      }
    }
    std::cout << "projector " << i << ": " << different << " of " << compared << " pixels differ\n";
    // Where sheets meet, a pixel's centre may fall on either side.
    EXPECT_LT(different, compared / 500) << i;
  }
}

TEST(ModelDepth, StaysWithinTheClipRange) {
  for (const auto& keystone : kKeystones) {
    const glm::dmat4 matrix = depthKeeping(keystone);
    const glm::dmat3 inverse = glm::inverse(keystone);
    for (const glm::dvec2 corner :
         {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(0, 0)}) {
      const glm::dvec3 h = inverse * glm::dvec3(corner, 1);
      for (const double depth : {-1.0, 0.0, 1.0}) {
        const glm::dvec4 clip = matrix * glm::dvec4(h.x / h.z, h.y / h.z, depth, 1);
        EXPECT_NEAR(clip.x / clip.w, corner.x, 1e-9);
        EXPECT_NEAR(clip.y / clip.w, corner.y, 1e-9);
        EXPECT_GT(clip.w, 0);
        EXPECT_LE(std::abs(clip.z / clip.w), 1 + 1e-9);
        EXPECT_EQ(std::signbit(clip.z), std::signbit(depth));
      }
    }
  }
  // Its frame reaches behind the projector.
  EXPECT_THROW((void)depthKeeping({{1, 0, 2}, {0, 1, 0}, {0, 0, 1}}), std::invalid_argument);
}

TEST(ModelRenderer, LeavesOutWhatAProjectorDoesNotSee) {
  Scene scene = testing::sceneOf(testing::triangleLattice(250));
  const auto all = scene.triangles();
  std::vector<ModelOutput> outputs;
  for (const double shift : {0.0, -3.0, -1000.0}) {
    ModelOutput output{.light = {.name = "p", .resolution = {64, 64}}};
    output.projectorFromDesktop = depthKeeping({{4, 0, 0}, {0, 4, 0}, {shift, shift, 1}});
    outputs.push_back(output);
  }
  outputs.push_back({.light = {.name = "whole", .resolution = {64, 64}}});
  devices::HeadlessContext context;
  ModelRenderer renderer(context, outputs);
  renderer.setScene(std::move(scene));
  renderer.setView({.window = {{100, 100}}, .viewer = {.eye = {0, 0, 120}}, .pose = {.zoom = 1.9}});
  renderer.draw();
  EXPECT_EQ(renderer.drawnParts(3).triangles, all);
  EXPECT_LT(renderer.drawnParts(0).triangles, all / 2);
  EXPECT_GT(renderer.drawnParts(0).triangles, 0U);
  EXPECT_EQ(renderer.drawnParts(2).triangles, 0U);
  EXPECT_FALSE(renderer.needsDraw());
}

}  // namespace
}  // namespace pixelflex::viewer
