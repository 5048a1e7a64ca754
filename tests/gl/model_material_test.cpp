// What surfaces look like: what lets see through, what is cut out, what shines, from both sides.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "devices/display/gl_context.h"
#include "tests/support/triangle_soups.h"
#include "viewer/model/model_renderer.h"
#include "viewer/model/picture_texture.h"
#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

using testing::sceneOf;
using testing::sheetAt;

constexpr devices::Size kFrame{64, 64};
const Material kWhite{.colour = glm::vec3(1), .lit = false};
const Material kRedGlass{.colour = {1, 0, 0}, .lit = false, .solidity = Solidity::kClear, .opacity = 0.5F};
const Material kGreenGlass{.colour = {0, 1, 0}, .lit = false, .solidity = Solidity::kClear, .opacity = 0.25F};

class ModelMaterialTest : public ::testing::Test {
 protected:
  /// The whole window of 2 x 2 shows what lies within 1 of the origin; yaw in degrees.
  devices::Image8 shown(const std::vector<Scene>& scenes, double yaw = 0) {
    ModelOutput plain{.light = {.name = "plain", .resolution = kFrame}};
    plain.light.dither = false;
    ModelOutput keystone = plain;
    keystone.projectorFromDesktop = depthKeeping({{1.1, 0, 0.1}, {0, 1.2, 0}, {0, 0, 1}});
    renderer_.emplace(context_, std::vector{plain, keystone}, ModelOptions{.samples = 1});
    Scene all;
    for (Scene scene : scenes) all.append(std::move(scene));
    renderer_->setScene(std::move(all));
    ModelView view{.window = {{2, 2}}, .viewer = {.eye = {0, 0, 50}}};
    view.pose.zoom = 1 / radiusInWindow({}, renderer_->bounds(), view.window) * glm::length(extent()) / 2;
    view.pose.yaw = yaw;
    renderer_->setView(view);
    renderer_->draw();
    return renderer_->readOutput(0);
  }
  [[nodiscard]] glm::dvec3 extent() const { return renderer_->bounds().high - renderer_->bounds().low; }
  static glm::ivec3 at(const devices::Image8& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
  }
  static glm::ivec3 middle(const devices::Image8& image) { return at(image, 31, 33); }
  static void expectLight(glm::ivec3 codes, glm::dvec3 light) {
    for (int c = 0; c < 3; ++c) {
      const double code = light[c] <= 0.0031308 ? 12.92 * light[c] : 1.055 * std::pow(light[c], 1 / 2.4) - 0.055;
      EXPECT_NEAR(codes[c], 255 * code, 1.5) << c;
    }
  }

  devices::HeadlessContext context_;
  const devices::GlDebugLog log_;
  std::optional<ModelRenderer> renderer_;
};

TEST_F(ModelMaterialTest, WhatIsClearLetsTheLightBehindItThrough) {
  const auto picture = shown({sceneOf(sheetAt(0, 1), kWhite), sceneOf(sheetAt(0.2F, 0.5F), kRedGlass)});
  expectLight(middle(picture), {1, 0.5, 0.5});
  expectLight(at(picture, 4, 4), {1, 1, 1});
}

TEST_F(ModelMaterialTest, TheOrderOfClearSheetsIsTheEyesOnEveryProjector) {
  // In the file the one that is before comes first.
  const std::vector scenes{sceneOf(sheetAt(0.4F, 1), kGreenGlass), sceneOf(sheetAt(0.2F, 1), kRedGlass),
                           sceneOf(sheetAt(0, 1), kWhite)};
  const glm::dvec3 redBehind = 0.75 * glm::dvec3(1, 0.5, 0.5) + 0.25 * glm::dvec3(0, 1, 0);
  expectLight(middle(shown(scenes)), redBehind);
  expectLight(middle(renderer_->readOutput(1)), redBehind);
  // Seen from behind the white hides all.
  expectLight(middle(shown(scenes, 180)), {1, 1, 1});
  const std::vector glasses{scenes[0], scenes[1]};
  expectLight(middle(shown(glasses)), 0.75 * glm::dvec3(0.5, 0, 0) + 0.25 * glm::dvec3(0, 1, 0));
  expectLight(middle(shown(glasses, 180)), 0.5 * glm::dvec3(0, 0.25, 0) + 0.5 * glm::dvec3(1, 0, 0));
}

TEST_F(ModelMaterialTest, WhatStandsBeforeClearThingsHidesThem) {
  const auto picture = shown({sceneOf(sheetAt(0, 1), kRedGlass), sceneOf(sheetAt(0.3F, 0.5F), kWhite)});
  expectLight(middle(picture), {1, 1, 1});
  expectLight(at(picture, 4, 4), {0.5, 0, 0});
}

TEST_F(ModelMaterialTest, PicturesCutOutHolesThatHaveDepth) {
  devices::Image8 picture({2, 1}, 4);
  for (int c = 0; c < 4; ++c) picture.at(0, 0, c) = 255;  // the left half is there
  Material leaf{.colour = {0, 1, 0}, .picture = 0, .lit = false, .solidity = Solidity::kCutOut};
  Scene cut = sceneOf(sheetAt(0.2F, 1), leaf);
  cut.pictures.push_back(picture);
  const auto seen = shown({cut, sceneOf(sheetAt(0, 1), kWhite)});
  for (const int x : {2, 16, 29}) expectLight(at(seen, x, 32), {0, 1, 0});
  expectLight(at(seen, 48, 32), {1, 1, 1});
}

TEST_F(ModelMaterialTest, BothSidesAreLitAndShineWhereTheLampIsThrownBack) {
  Material plain{.colour = glm::vec3(0.3F)};
  Material shiny = plain;
  shiny.shine = glm::vec3(0.5F);
  shiny.shininess = 40;
  const int dull = middle(shown({sceneOf(sheetAt(0, 1), plain)})).x;
  EXPECT_GT(dull, 60);
  EXPECT_NEAR(middle(shown({sceneOf(sheetAt(0, 1), plain)}, 180)).x, dull, 2);
  // The lamp is to the right of the eye and above it: turned towards their middle the sheet is brightest.
  const double towards = 11;
  const auto gain = [&](double yaw) {
    return middle(shown({sceneOf(sheetAt(0, 1), shiny)}, yaw)).x -
           middle(shown({sceneOf(sheetAt(0, 1), plain)}, yaw)).x;
  };
  EXPECT_GT(gain(towards), gain(-towards) + 5);
  EXPECT_GE(gain(-40), 0);
  EXPECT_LE(gain(-40), 1);
}

TEST_F(ModelMaterialTest, EmissionIsThereWithoutAnyLamp) {
  expectLight(middle(shown({sceneOf(sheetAt(0, 1), {.colour = glm::vec3(0), .emission = {0.2F, 0.4F, 0}})})),
              {0.2, 0.4, 0});
}

TEST(ModelPicture, OneThatTheCardDoesNotTakeIsSaidInWords) {
  const devices::HeadlessContext context;
  try {
    (void)pictureTexture(devices::Image8({70000, 1}, 4), false);
    FAIL() << "is drawn black";
  } catch (const RendererError& error) {
    EXPECT_NE(std::string(error.what()).find("70000x1 pixels"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW((void)pictureTexture(devices::Image8({7, 1}, 4), false));
}

}  // namespace
}  // namespace pixelflex::viewer
