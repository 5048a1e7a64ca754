// Models as files: what they become.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <sstream>
#include <string>

#include "devices/image/png_file.h"
#include "tests/support/triangle_soups.h"
#include "tests/unit/model_files.h"

namespace pixelflex::viewer {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using ModelSceneTest = ModelFilesTest;

glm::vec3 normalOf(const SceneVertex& vertex) {
  return glm::vec3(glm::unpackSnorm3x10_1x2(vertex.normal));
}

TEST_F(ModelSceneTest, ACubeHasItsEdges) {
  const Scene scene = load("cube.obj", kCube);
  EXPECT_EQ(scene.triangles(), 12U);
  EXPECT_EQ(scene.bounds().low, glm::vec3(0));
  EXPECT_EQ(scene.bounds().high, glm::vec3(1));
  EXPECT_THAT(scene.warnings, IsEmpty());
  // Not smoothed: a corner has three normals, so 24 vertices, each along an axis.
  EXPECT_EQ(scene.vertices.size(), 24U);
  for (const auto& vertex : scene.vertices) {
    const glm::vec3 n = glm::abs(normalOf(vertex));
    EXPECT_NEAR(std::max({n.x, n.y, n.z}), 1, 0.01);
    EXPECT_NEAR(n.x + n.y + n.z, 1, 0.02);
  }
}

TEST_F(ModelSceneTest, WhatIsRoundIsSmooth) {
  std::ostringstream obj;
  constexpr int kSides = 24;
  for (int i = 0; i < kSides; ++i) {
    const double a = 2 * M_PI * i / kSides;
    for (int top = 0; top < 2; ++top) obj << "v " << std::cos(a) << " " << top << " " << std::sin(a) << "\n";
  }
  for (int i = 0; i < kSides; ++i) {
    const int a = 2 * i + 1;
    const int b = 2 * ((i + 1) % kSides) + 1;
    obj << "f " << a << " " << a + 1 << " " << b + 1 << " " << b << "\n";
  }
  const Scene scene = load("tube.obj", obj.str());
  EXPECT_EQ(scene.triangles(), 2U * kSides);
  for (const auto& vertex : scene.vertices) {
    const glm::vec3 outwards(vertex.position.x, 0, vertex.position.z);
    EXPECT_GT(std::abs(glm::dot(normalOf(vertex), outwards)), 0.99);
  }
}

TEST_F(ModelSceneTest, MaterialsAndPicturesAreRead) {
  devices::Image8 picture({4, 2}, 3);
  picture.at(1, 0, 2) = 200;
  devices::writePng(folder_ / "wood.png", picture);
  file("colours.mtl", "newmtl red\nKd 1 0 0\nnewmtl wood\nKd 1 1 1\nmap_Kd wood.png\n");
  const Scene scene =
      load("two.obj",
           "mtllib colours.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3\n"
           "usemtl wood\nf 1/1 3/3 2/2\n");
  ASSERT_EQ(scene.parts.size(), 2U);
  ASSERT_EQ(scene.pictures.size(), 1U);
  EXPECT_TRUE(scene.pictures.front() == picture);
  bool red = false;
  bool wood = false;
  for (const auto& part : scene.parts) {
    const auto& material = scene.materials.at(static_cast<std::size_t>(part.material));
    red = red || (material.colour == glm::vec3(1, 0, 0) && material.picture == -1);
    wood = wood || (material.colour == glm::vec3(1) && material.picture == 0);
  }
  EXPECT_TRUE(red);
  EXPECT_TRUE(wood);
  // The top-left corner of a picture is (0, 0).
  for (const auto& vertex : scene.vertices) EXPECT_FLOAT_EQ(vertex.texture.y, 1 - vertex.position.y);
}

TEST_F(ModelSceneTest, MaterialsSayWhatLetsSeeThroughAndWhatShines) {
  devices::Image8 leaf({8, 8}, 4);
  for (int y = 0; y < 8; ++y) leaf.at(2, y, 3) = 255;
  devices::writePng(folder_ / "leaf.png", leaf);
  devices::Image8 haze({8, 8}, 3);
  std::ranges::fill(haze.samples(), std::uint8_t{128});
  devices::writePng(folder_ / "haze.png", haze);
  file("m.mtl",
       "newmtl glass\nKd 0 1 0\nd 0.25\nillum 2\nKs 1 1 1\nNs 50\n"
       "newmtl leaf\nmap_Kd leaf.png\nKe 0.5 0 0\nnewmtl haze\nmap_Kd leaf.png\nmap_d haze.png\n");
  std::string cube = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
  for (const std::string material : {"glass", "leaf", "haze"}) cube += "usemtl " + material + "\nf 1/1 2/1 3/1\n";
  const Scene scene = load("m.obj", cube);
  std::map<Solidity, Material> found;
  for (const auto& part : scene.parts) {
    const auto& material = scene.materials[static_cast<std::size_t>(part.material)];
    if (material.opacity < 1) {
      EXPECT_EQ(material.solidity, Solidity::kClear);
      EXPECT_EQ(material.shine, glm::vec3(1));
      EXPECT_EQ(material.shininess, 50);
    } else {
      found[material.solidity] = material;
    }
  }
  ASSERT_TRUE(found.contains(Solidity::kCutOut));
  EXPECT_GT(found[Solidity::kCutOut].emission.r, 0.1F);
  const auto pictureOf = [&](Solidity solidity) {
    return scene.pictures.at(static_cast<std::size_t>(found[solidity].picture));
  };
  EXPECT_EQ(pictureOf(Solidity::kCutOut).at(2, 3, 3), 255);
  EXPECT_EQ(pictureOf(Solidity::kCutOut).at(3, 3, 3), 0);
  ASSERT_TRUE(found.contains(Solidity::kClear));
  EXPECT_EQ(pictureOf(Solidity::kClear).at(3, 3, 3), 128);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ModelSceneTest, AFileIsFoundFromWhereOneStands) {
  file("m.mtl", "newmtl m\nKd 1 0 0\n");
  file("here.obj", "mtllib m.mtl\nusemtl m\n" + kCube);
  const auto stood = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  const std::array<std::filesystem::path, 2> files{"here.obj", "./here.obj"};
  const Scene scene = loadScene(files);
  std::filesystem::current_path(stood);
  EXPECT_EQ(scene.triangles(), 24U);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ModelSceneTest, AMissingPictureIsNamed) {
  file("lost.mtl", "newmtl wood\nKd 0.5 0.5 0.5\nmap_Kd lost.png\n");
  const Scene scene = load("lost.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n");
  EXPECT_EQ(scene.triangles(), 1U);
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("lost.obj"), HasSubstr("lost.png"))));
}

/// Little-endian chunks, as a binary glTF has them.
std::string glbOf(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto length = static_cast<std::uint32_t>(28 + json.size() + binary.size());
  return "glTF" + bytesOf(2U) + bytesOf(length) + bytesOf(static_cast<std::uint32_t>(json.size())) + "JSON" + json +
         bytesOf(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
}

TEST_F(ModelSceneTest, AGltfBringsItsPicturesAndNodes) {
  devices::Image8 picture({2, 2}, 3);
  picture.at(0, 1, 1) = 99;
  devices::writePng(folder_ / "inside.png", picture);
  std::ifstream stream(folder_ / "inside.png", std::ios::binary);
  const std::string png((std::istreambuf_iterator<char>(stream)), {});
  std::filesystem::remove(folder_ / "inside.png");
  std::string binary;
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) binary += bytesOf(v);
  for (const float v : {0.F, 1.F, 1.F, 1.F, 0.F, 0.F}) binary += bytesOf(v);
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[5,0,0],"scale":[2,2,2]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],)"
      R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"baseColorTexture":{"index":0}}}],)"
      R"("textures":[{"source":0}],"images":[{"bufferView":2,"mimeType":"image/png"}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
      R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],)"
      R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},)"
      R"({"buffer":0,"byteOffset":60,"byteLength":)" +
      std::to_string(png.size()) + R"(}],"buffers":[{"byteLength":)" + std::to_string(60 + png.size()) + "}]}";
  const Scene scene = load("one.GLB", glbOf(json, binary + png));
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.bounds().low, glm::vec3(5, 0, 0));
  EXPECT_EQ(scene.bounds().high, glm::vec3(7, 2, 0));
  ASSERT_EQ(scene.pictures.size(), 1U);
  EXPECT_TRUE(scene.pictures.front() == picture);
  const auto& material = scene.materials.at(static_cast<std::size_t>(scene.parts.at(0).material));
  EXPECT_EQ(material.colour, glm::vec3(0.5F, 0.25F, 1));  // light, not codes
  // As in the file: (0, 1) is the bottom-left corner of the picture.
  for (const auto& vertex : scene.vertices) EXPECT_FLOAT_EQ(vertex.texture.y, 1 - vertex.position.y / 2);
}

TEST_F(ModelSceneTest, CornersHaveTheirOwnColours) {
  const Scene scene =
      load("colours.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 128 0\n0 1 0 0 0 7\n3 0 1 2\n");
  ASSERT_EQ(scene.vertices.size(), 3U);
  for (const auto& vertex : scene.vertices) {
    const std::uint32_t expected = vertex.position.x > 0 ? 128U << 8 : vertex.position.y > 0 ? 7U << 16 : 255U;
    EXPECT_EQ(vertex.colour & 0xFFFFFFU, expected);
  }
}

TEST_F(ModelSceneTest, SeveralFilesShareTheirCoordinates) {
  const std::array files{file("a.obj", kCube), file("b.obj", "v 3 0 0\nv 4 0 0\nv 3 1 0\nf 1 2 3\n")};
  const Scene scene = loadScene(files);
  EXPECT_EQ(scene.triangles(), 13U);
  EXPECT_EQ(scene.bounds().high, glm::vec3(4, 1, 1));
  for (const auto index : scene.indices) ASSERT_LT(index, scene.vertices.size());
  for (const auto& part : scene.parts) {
    EXPECT_LT(static_cast<std::size_t>(part.material), scene.materials.size());
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
      const auto p = scene.vertices[scene.indices.at(i)].position;
      EXPECT_EQ(glm::clamp(p, part.bounds.low, part.bounds.high), p);
    }
  }
}

TEST(TriangleSoup, PartsLieTogether) {
  constexpr int kSide = 200;
  const Scene scene = testing::sceneOf(testing::triangleLattice(kSide));
  EXPECT_EQ(scene.triangles(), std::size_t{kSide} * kSide);
  EXPECT_GE(scene.parts.size(), 4U);
  float area = 0;
  std::size_t triangles = 0;
  for (const auto& part : scene.parts) {
    const glm::vec3 extent = part.bounds.high - part.bounds.low;
    area += extent.x * extent.y;
    triangles += part.count / 3;
  }
  EXPECT_EQ(triangles, scene.triangles());
  EXPECT_LT(area, 1.1F * (kSide + 1) * (kSide + 1));
}

}  // namespace
}  // namespace pixelflex::viewer
