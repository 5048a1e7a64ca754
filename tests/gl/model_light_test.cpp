// The light of one pass, pixel by pixel, against the formula of OutputPlan.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "devices/display/gl_context.h"
#include "tests/support/triangle_soups.h"
#include "viewer/model/model_renderer.h"

namespace pixelflex::viewer {
namespace {

constexpr devices::Size kFrame{64, 48};
const glm::dvec3 kLight(0.7, 0.3, 0.15);

devices::Image16 map(int seed) {
  devices::Image16 image(kFrame, 1);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      image.at(x, y) = static_cast<std::uint16_t>((x * 977 + y * 1409 * seed + seed * 333) % 65536);
    }
  }
  return image;
}

double srgb(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

/// Shown by a projector with this light, the window full of the sheet or, `away`, without it.
devices::Image8 shown(const OutputPlan& light, bool away = false) {
  devices::HeadlessContext context;
  const devices::GlDebugLog log;
  ModelRenderer renderer(context, {{.light = light}});
  renderer.setScene(testing::sceneOf(testing::sheetAt(0, 150), {.colour = kLight, .lit = false}));
  ModelView view{.window = {{100, 100}}, .viewer = {.eye = {0, 0, 120}}, .pose = {.zoom = 4}};
  if (away) view.pose.shift.x = 100;
  renderer.setView(view);
  renderer.draw();
  return renderer.readOutput(0);
}

/// The largest difference in codes.
int farthest(const OutputPlan& plan, const devices::Image8& frame, glm::dvec3 sceneLight) {
  int farthest = 0;
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      glm::dvec3 light = glm::dmat3(plan.colour) * sceneLight;
      if (!plan.alpha.empty()) light *= plan.alpha.at(x, y) / 65535.0;
      if (!plan.gain.empty()) light *= plan.gain.at(x, y) / 65535.0;
      if (!plan.black.empty()) light += glm::dvec3(plan.largestBlack) * (plan.black.at(x, y) / 65535.0);
      for (int c = 0; c < 3; ++c) {
        const int code = static_cast<int>(std::lround(255 * srgb(std::clamp(light[c], 0.0, 1.0))));
        farthest = std::max(farthest, std::abs(code - frame.at(x, y, c)));
      }
    }
  }
  return farthest;
}

OutputPlan plainPlan() {
  OutputPlan plan{.name = "p", .resolution = kFrame};
  plan.dither = false;
  return plan;
}

TEST(ModelLight, IsTheFormulasWithEveryPartOfIt) {
  OutputPlan plan = plainPlan();
  EXPECT_LE(farthest(plan, shown(plan), kLight), 1);
  plan.alpha = map(1);
  EXPECT_LE(farthest(plan, shown(plan), kLight), 1);
  plan.gain = map(2);
  EXPECT_LE(farthest(plan, shown(plan), kLight), 1);
  plan.black = map(3);
  plan.largestBlack = {0.05F, 0.02F, 0.04F};
  EXPECT_LE(farthest(plan, shown(plan), kLight), 1);
  plan.colour = {{0.9F, 0.05F, 0}, {-0.02F, 0.8F, 0.1F}, {0.1F, 0, 0.7F}};
  EXPECT_LE(farthest(plan, shown(plan), kLight), 1);
}

TEST(ModelLight, BlackIsLiftedWhereThereIsNoModel) {
  OutputPlan plan = plainPlan();
  plan.alpha = map(1);
  plan.black = map(3);
  plan.largestBlack = {0.05F, 0.02F, 0.04F};
  EXPECT_LE(farthest(plan, shown(plan, true), glm::dvec3(0)), 1);
}

TEST(ModelLight, TheResponseComesLast) {
  OutputPlan plan = plainPlan();
  // A projector that doubles light^(1/2.2) until it is full.
  for (auto& channel : plan.inverseResponse) {
    for (int i = 0; i < 256; ++i) channel.push_back(static_cast<float>(i) / 510);
  }
  const auto frame = shown(plan);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(frame.at(30, 20, c), 127.5 * std::pow(kLight[c], 1 / 2.2), 1) << c;
  }
}

}  // namespace
}  // namespace pixelflex::viewer
