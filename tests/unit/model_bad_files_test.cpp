// Bad models: an error or a named warning, and never the end of the program.
#include <sys/resource.h>

#include <cmath>

#include "devices/image/png_file.h"
#include "tests/unit/model_files.h"

namespace pixelflex::viewer {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using ModelBadFilesTest = ModelFilesTest;

/// One mesh of so many corners, out of one buffer.
std::string gltfOf(std::uint64_t corners, const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":)" +
         std::to_string(corners) + R"(,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":12}],"buffers":[)" +
         buffer + "]}";
}

TEST_F(ModelBadFilesTest, CoordinatesThatAreNoNumbersAreLeftOutByName) {
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

TEST_F(ModelBadFilesTest, WhatIsCutOffOrEmptyIsRefusedInWords) {
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

TEST_F(ModelBadFilesTest, ABillionClaimedVerticesCostNothing) {
  EXPECT_THAT(failure("huge.ply", binaryPly(plyHeader(1'000'000'000, 1), "")), HasSubstr("1000000000 of vertex"));
  EXPECT_THAT(failure("huge.stl", std::string(80, ' ') + bytesOf(std::uint32_t{1'000'000'000})),
              HasSubstr("1000000000 triangles"));
  const std::string twelveBytes = R"({"byteLength":12,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"})";
  EXPECT_THAT(failure("huge.gltf", gltfOf(1'000'000'000, twelveBytes)), HasSubstr("huge.gltf"));
  EXPECT_THAT(failure("buffer.gltf", gltfOf(3, R"({"byteLength":99000000000})")), HasSubstr("buffer.gltf"));
  EXPECT_THAT(failure("huge.txt.ply", "ply\nformat ascii 1.0\n" + plyHeader(1'000'000'000, 1) + "0 0 0\n"),
              HasSubstr("1000000000 of vertex"));
  EXPECT_THAT(failure("indices.obj", kCube + "f 1 2 1000000000\n"), HasSubstr("indices.obj"));
  EXPECT_THAT(failure("more.ply", binaryPly(plyHeader(18'446'744'073'709'551'615U, 3), "x")), HasSubstr("more.ply"));
  rusage readers{};
  ::getrusage(RUSAGE_CHILDREN, &readers);
  EXPECT_LT(readers.ru_maxrss, 500'000) << "KiB";
}

/// A model alone in a folder, beside which lies what it must not reach.
TEST_F(ModelBadFilesTest, NothingOutsideOfTheModelsFolderIsOpened) {
  file("red.mtl", "newmtl m\nKd 1 0 0\n");
  std::filesystem::create_directory(folder_ / "in");
  const std::string cube = "usemtl m\n" + kCube;
  for (const std::string& name :
       {std::string("../red.mtl"), (folder_ / "red.mtl").string(), std::string("/dev/zero")}) {
    const Scene scene = load("in/cube.obj", "mtllib " + name + "\n" + cube);
    EXPECT_EQ(scene.triangles(), 12U);
    for (const auto& material : scene.materials) EXPECT_NE(material.colour, glm::vec3(1, 0, 0));
    EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("cube.obj"), HasSubstr("no file of the model's folder"))));
  }
  EXPECT_THAT(failure("in/far.gltf", gltfOf(3, R"({"byteLength":36,"uri":"../far.bin"})")), HasSubstr("far.gltf"));
  // Names of another machine are found beside the model.
  file("in/red.mtl", "newmtl m\nKd 1 0 0\nmap_Kd C:\\\\pictures\\wood.png\n");
  devices::writePng(folder_ / "in" / "wood.png", devices::Image8({2, 2}, 3));
  EXPECT_EQ(load("in/cube.obj", "mtllib red.mtl\n" + cube).pictures.size(), 1U);
}

TEST_F(ModelBadFilesTest, FacesOfCornersThatAreNotThereAreAnErrorOrLeftOut) {
  for (const std::string& name : {std::string("far.obj"), std::string("back.obj"), std::string("huge.obj")}) {
    const std::string corner = name == "far.obj" ? "1000000000" : name == "back.obj" ? "-1000000000" : "99999999999999";
    const std::array files{file(name, kCube + "f 1 2 " + corner + "\n")};
    try {
      const Scene scene = loadScene(files);
      for (const auto index : scene.indices) ASSERT_LT(index, scene.vertices.size());
    } catch (const ModelError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
  }
}

}  // namespace
}  // namespace pixelflex::viewer
