// Models as files: what they become, and what becomes of bad ones.
#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>
#include <random>
#include <sstream>
#include <string>

#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"
#include "viewer/model/scene_file.h"
#include "viewer/model/triangle_soup.h"

namespace pixelflex::viewer {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

class ModelSceneTest : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  Scene load(const std::string& name, const std::string& bytes) {
    const std::array files{file(name, bytes)};
    return loadScene(files);
  }
  std::string failure(const std::string& name, const std::string& bytes) {
    try {
      (void)load(name, bytes);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "no error";
  }
  testing::TemporaryFolder folder_;
};

glm::vec3 normalOf(const SceneVertex& vertex) {
  return glm::vec3(glm::unpackSnorm3x10_1x2(vertex.normal));
}

template <class T>
std::string bytesOf(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string binaryPly(const std::string& counts, const std::string& body) {
  return "ply\nformat binary_little_endian 1.0\n" + counts + body;
}

std::string plyHeader(std::uint64_t vertices, std::uint64_t faces) {
  return "element vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
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

TEST_F(ModelSceneTest, AMissingPictureIsNamed) {
  file("lost.mtl", "newmtl wood\nKd 0.5 0.5 0.5\nmap_Kd lost.png\n");
  const Scene scene = load("lost.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n");
  EXPECT_EQ(scene.triangles(), 1U);
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("lost.obj"), HasSubstr("lost.png"))));
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

TEST_F(ModelSceneTest, CoordinatesThatAreNoNumbersAreLeftOutByName) {
  std::string body;
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, NAN, 1.F, 0.F}) body += bytesOf(v);
  for (const std::int32_t last : {2, 3}) {
    body += '\3' + bytesOf(std::int32_t{0}) + bytesOf(std::int32_t{1}) + bytesOf(last);
  }
  const Scene scene = load("holes.ply", binaryPly(plyHeader(4, 2), body));
  EXPECT_EQ(scene.triangles(), 1U);
  EXPECT_THAT(scene.warnings,
              ElementsAre(AllOf(HasSubstr("holes.ply"), HasSubstr("no numbers"), HasSubstr("1 triangles"))));
}

TEST_F(ModelSceneTest, WhatIsCutOffOrEmptyIsRefusedInWords) {
  EXPECT_THAT(failure("empty.obj", ""), AllOf(HasSubstr("empty.obj"), HasSubstr("is empty")));
  EXPECT_THAT(failure("points.obj", "v 0 0 0\nv 1 0 0\n"), HasSubstr("points.obj"));
  EXPECT_THAT(failure("cut.ply", binaryPly(plyHeader(1'000, 2'000), "short")), HasSubstr("cut off"));
  EXPECT_THAT(failure("text.ply", "ply\nformat ascii 1.0\n" + plyHeader(30, 10) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
              AllOf(HasSubstr("30 of vertex and 10 of face"), HasSubstr("cut off")));
  EXPECT_THAT(failure("lines.ply", "ply\nformat ascii 1.0\n" + plyHeader(3, 9) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
              AllOf(HasSubstr("only 4 lines"), HasSubstr("cut off")));
  EXPECT_THAT(failure("cut.stl", std::string(80, ' ') + bytesOf(std::uint32_t{500}) + std::string(100, '\0')),
              AllOf(HasSubstr("500 triangles"), HasSubstr("cut off")));
  EXPECT_THAT(failure("cut.glb", "glTF" + bytesOf(2U) + bytesOf(100'000U) + "JSON"), HasSubstr("cut off"));
  EXPECT_THAT(failure("cut.gltf", "{\"asset\": {\"version\""), HasSubstr("cut.gltf"));
  EXPECT_THAT(failure("what.xyz", "no model at all"), AllOf(HasSubstr("what.xyz"), HasSubstr("OBJ, PLY")));
  const std::array none{folder_ / "none.obj"};
  EXPECT_THROW((void)loadScene(none), ModelError);
}

TEST_F(ModelSceneTest, ABillionClaimedVerticesCostNothing) {
  EXPECT_THAT(failure("huge.ply", binaryPly(plyHeader(1'000'000'000, 1), "")), HasSubstr("1000000000 of vertex"));
  EXPECT_THAT(failure("huge.stl", std::string(80, ' ') + bytesOf(std::uint32_t{1'000'000'000})),
              HasSubstr("1000000000 triangles"));
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":1000000000,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":12}],)"
      R"("buffers":[{"byteLength":12,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]})";
  EXPECT_THAT(failure("huge.gltf", gltf), HasSubstr("huge.gltf"));
}

// Whatever a few changed bytes make of a file: a scene that is sound, or an error.
TEST_F(ModelSceneTest, DamagedFilesEndInAnErrorAtMost) {
  std::string body;
  for (const float v : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) body += bytesOf(v);
  body += '\3' + bytesOf(std::int32_t{0}) + bytesOf(std::int32_t{1}) + bytesOf(std::int32_t{2});
  const std::array<std::pair<std::string, std::string>, 3> sound{
      {{"x.obj", kCube},
       {"x.ply", binaryPly(plyHeader(3, 1), body)},
       {"x.stl", std::string(80, 'a') + bytesOf(1U) + std::string(50, '\1')}}};
  std::mt19937 random(7);
  int shown = 0;
  for (int round = 0; round < 60; ++round) {
    auto [name, bytes] = sound[static_cast<std::size_t>(round) % sound.size()];
    for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (round % 5 == 0) bytes.resize(random() % bytes.size());
    try {
      const Scene scene = load(name, bytes);
      ++shown;
      for (const auto index : scene.indices) ASSERT_LT(index, scene.vertices.size());
      for (const auto& vertex : scene.vertices) ASSERT_TRUE(std::isfinite(vertex.position.x + vertex.position.y));
    } catch (const ModelError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
  }
  EXPECT_GT(shown, 0);
}

TEST(TriangleSoup, PartsLieTogether) {
  TriangleSoup soup;
  constexpr int kSide = 200;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
        soup.push_back(
            {.position = {static_cast<float>(x) + corner.x, static_cast<float>(y) + corner.y, 0}, .normal = {0, 0, 1}});
      }
    }
  }
  Scene scene;
  scene.materials.emplace_back();
  addToScene(soup, 0, scene);
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
