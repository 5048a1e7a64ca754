#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/store/store.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

using calib::formatWall;
using calib::parseWall;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A wall that differs from the defaults in everything.
calib::Wall richWall() {
  calib::Wall wall = exampleWall();
  wall.surface.shape = calib::SurfaceShape::kCylinder;
  wall.surface.cylinderRadius = 3000.25;
  wall.surface.units = "Zoll \"ü\": #1";
  wall.surface.fiducials[1] = {.aruco = {}, .pointInCamera = glm::dvec2(1.5, 1e-7), .pointInWall = {0.1, -1.0 / 3}};
  wall.surface.fiducials.push_back({.aruco = 17, .pointInCamera = {}, .pointInWall = {1500, 10}});
  wall.surface.fiducials.push_back({.aruco = 18, .pointInCamera = {}, .pointInWall = {1500, 1490}});
  wall.camera = {.source = "v4l2:/dev/video0", .checkerboard = calib::Checkerboard{7, 5, 28.5}};
  wall.projectors[0].output.kind = calib::OutputKind::kDisplay;
  wall.projectors[0].output.monitor = "";
  wall.projectors[0].output.display = ":0.1";
  wall.projectors[0].output.at = {-1024, 7};
  calib::ProjectorConfig second;
  second.name = "null";
  second.resolution = {16, 16384};
  second.output.kind = calib::OutputKind::kSim;
  wall.projectors.push_back(second);
  wall.blend = {.densityExponent = 2.5,
                .priorityFeather = 60,
                .stack = calib::StackRule::kLeftRight,
                .uniformity = 0.75,
                .evenBlack = true};
  wall.display = {.aspect = calib::AspectRatio{16, 9.5}, .margin = 0};
  wall.desktop = {.density = calib::DensityRule::kFixed,
                  .pixelsPerUnit = 0.7,
                  .oversampling = 1.25,
                  .filter = calib::DesktopFilter::kNearest,
                  .filterDomain = calib::FilterDomain::kLinear};
  wall.transfer = calib::Transfer::kLinear;
  wall.rig = "my rig.yaml";
  return wall;
}

/// The example with one piece of text replaced.
std::string exampleWith(const std::string& from, const std::string& to) {
  std::string text = dataFile("wall-v1.yaml");
  const std::size_t place = text.find(from);
  if (place == std::string::npos) throw std::runtime_error("no such text in the example: " + from);
  return text.replace(place, from.size(), to);
}

TEST(StoreWall, ReadsTheExampleOfTheDocumentation) {
  EXPECT_EQ(parseWall(dataFile("wall-v1.yaml"), "wall.yaml"), exampleWall());
}

TEST(StoreWall, WritesTheKeysOfTheDocumentation) {
  EXPECT_EQ(formatWall(exampleWall()),
            "# A PixelFlex wall: what there is. Check it with: pixelflex check WALL\n"
            "format: pixelflex-wall\n"
            "version: 1\n"
            "surface:\n"
            "  shape: planar\n"
            "  units: mm\n"
            "  fiducials:\n"
            "    - {aruco: 0, at: [0, 0]}\n"
            "    - {aruco: 1, at: [3000, 0]}\n"
            "    - {aruco: 2, at: [3000, 1500]}\n"
            "    - {aruco: 3, at: [0, 1500]}\n"
            "camera:\n"
            "  source: photos\n"
            "  checkerboard: {corners: [9, 6], square: 30}\n"
            "projectors:\n"
            "  - name: p1\n"
            "    resolution: [1024, 768]\n"
            "    output: {monitor: HDMI-1}\n"
            "    gamma: readings/p1.csv\n"
            "    control: {driver: pjlink, at: \"tcp://10.0.0.5:4352\"}\n"
            "    mirror: {driver: ptu, at: \"tcp://10.0.0.9:2101\"}\n"
            "blend: {density_exponent: 2}\n"
            "display: {aspect: any, margin: 24}\n"
            "desktop: {density: mean, oversampling: 1, filter: catmull-rom, filter_domain: srgb}\n"
            "transfer: srgb\n");
}

TEST(StoreWall, RoundTripsEverything) {
  for (const auto& wall : {exampleWall(), richWall(), flatWall(3, 2)}) {
    EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall) << formatWall(wall);
  }
}

TEST(StoreWall, RoundTripsEveryOutputAndShape) {
  for (const auto shape : {calib::SurfaceShape::kPlanar, calib::SurfaceShape::kCamera}) {
    for (const auto kind : {calib::OutputKind::kNone, calib::OutputKind::kSim, calib::OutputKind::kMonitor}) {
      calib::Wall wall = exampleWall();
      wall.surface.shape = shape;
      wall.projectors[0].output.kind = kind;
      wall.projectors[0].output.monitor = kind == calib::OutputKind::kMonitor ? "DP 1: \"x\"\\" : "";
      wall.rig = "rig.yaml";
      wall.desktop.density = calib::DensityRule::kMax;
      EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall) << formatWall(wall);
    }
  }
}

TEST(StoreWall, RoundTripsEveryFilter) {
  for (const auto filter :
       {calib::DesktopFilter::kCatmullRom, calib::DesktopFilter::kBilinear, calib::DesktopFilter::kNearest}) {
    for (const auto domain : {calib::FilterDomain::kSrgb, calib::FilterDomain::kLinear}) {
      calib::Wall wall = exampleWall();
      wall.desktop.filter = filter;
      wall.desktop.filterDomain = domain;
      EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall) << formatWall(wall);
    }
  }
}

TEST(StoreWall, GammaMayBeMeasuredByTheCamera) {
  const calib::Wall wall = parseWall(exampleWith("gamma: readings/p1.csv", "gamma: camera"), "wall.yaml");
  EXPECT_TRUE(wall.projectors[0].gammaByCamera);
  EXPECT_FALSE(wall.projectors[0].gamma);
  EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall);
  EXPECT_EQ(parseWall(exampleWith("readings/p1.csv", "./camera"), "wall.yaml").projectors[0].gamma, "./camera");
}

TEST(StoreWall, RoundTripsTheCamerasTransfer) {
  for (const auto transfer : {calib::Transfer::kLinear, calib::Transfer::kSrgb}) {
    calib::Wall wall = exampleWall();
    wall.camera.transfer = transfer;
    EXPECT_EQ(parseWall(formatWall(wall), "wall.yaml"), wall) << formatWall(wall);
  }
  EXPECT_THAT(wallProblems(exampleWith("source: photos", "source: photos\n  transfer: raw")),
              ElementsAre(::testing::HasSubstr("transfer: expected srgb or linear, found \"raw\"")));
}

TEST(StoreWall, MigratesVersionZero) {
  EXPECT_EQ(parseWall(dataFile("wall-v0.yaml"), "wall.yaml"), exampleWall());
}

TEST(StoreWall, RefusesBothSpellingsOfAMigratedKey) {
  const std::string text = dataFile("wall-v0.yaml") + "blend: {density_exponent: 3}\n";
  EXPECT_THAT(wallProblems(text), ElementsAre("23:1 unknown key \"blend_exponent\""));
}

TEST(StoreWall, RefusesANewerVersion) {
  EXPECT_THAT(wallProblems(exampleWith("version: 1", "version: 7")),
              ElementsAre("3:10 version: written by a newer PixelFlex (version 7, this program knows up to 1)"));
}

TEST(StoreWall, RefusesAnotherFormat) {
  EXPECT_THAT(wallProblems(exampleWith("pixelflex-wall", "pixelflex-calibration")),
              ElementsAre("2:9 format: this is not a pixelflex-wall file: no \"format: pixelflex-wall\""));
}

TEST(StoreWall, FindsAllProblemsAtOnceWithTheirPlaces) {
  std::string text = exampleWith("fiducials:", "fiducal: 1\n  fiducials:");
  text.replace(text.find("[1024, 768]"), 11, "[1024, 8]");
  text.replace(text.find("margin: 24"), 10, "margin: many");
  text.replace(text.find("oversampling: 1.0"), 17, "oversampling: 9");
  EXPECT_THAT(wallProblems(text), ElementsAre("8:3 unknown key \"fiducal\"; did you mean \"fiducials\"?",
                                              "19:24 resolution: expected a whole number from 16 to 16384, found \"8\"",
                                              "25:32 margin: expected a whole number from 0 to 4096, found \"many\"",
                                              "26:40 oversampling: expected a number from 0.25 to 8, found \"9\""));
}

struct BadEdit {
  std::string from;
  std::string to;
  std::string message;
};

void PrintTo(const BadEdit& edit, std::ostream* stream) {
  *stream << edit.from << " -> " << edit.to;
}

class StoreWallEdit : public ::testing::TestWithParam<BadEdit> {};

TEST_P(StoreWallEdit, IsRefusedWithAClearMessage) {
  const auto problems = wallProblems(exampleWith(GetParam().from, GetParam().to));
  ASSERT_EQ(problems.size(), 1U) << ::testing::PrintToString(problems);
  EXPECT_THAT(problems[0], ::testing::HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Edits, StoreWallEdit,
    ::testing::Values(
        BadEdit{"    - {aruco: 3, at: [0, 1500]}\n", "", "fewer than four fiducials: the collineation needs at least"},
        BadEdit{"at: [3000, 1500]", "at: [1500, 0]", "on one line"}, BadEdit{"aruco: 3", "aruco: 2", "listed twice"},
        BadEdit{"at: [0, 1500]", "at: [0, 0]", "another fiducial is at the same place"},
        BadEdit{"aruco: 3", "aruco: 50", "from 0 to 49"}, BadEdit{"aruco: 3, ", "", "either \"aruco: ID\" or"},
        BadEdit{"aruco: 3", "aruco: 3, camera: [1, 2]", "either \"aruco: ID\" or"},
        BadEdit{"at: [0, 1500]", "at: [0, .nan]", "expected a number"},
        BadEdit{"at: [0, 1500]", "at: [0, inf]", "expected a number"},
        BadEdit{"at: [0, 1500]", "at: [0]", "expected a list of 2, found 1"},
        BadEdit{"shape: planar", "shape: {cylinder: {radius: 0}}", "radius: expected a number"},
        BadEdit{"shape: planar", "shape: {cylinder: {radius: 3000}}", "a cylinder needs at least six"},
        BadEdit{"shape: planar", "shape: round", "expected planar, camera or"},
        BadEdit{"source: photos", "source: film", "expected photos, sim, none"},
        BadEdit{"source: photos", "source: \"v4l2:\"", "expected photos, sim, none"},
        BadEdit{"source: photos", "source: sim", "\"rig: FILE\" is needed"},
        BadEdit{"corners: [9, 6]", "corners: [9, 2]", "corners: expected a whole number from 3"},
        BadEdit{"name: p1", "name: a/b", "may only hold letters"},
        BadEdit{"name: p1", "name: .p", "may only hold letters"},
        BadEdit{"name: p1", "name: \"\"", "must not be empty"},
        BadEdit{"  - name: p1\n", "  - name: p1\n    resolution: [640, 480]\n  - name: p1\n",
                "two projectors have the"},
        BadEdit{"[1024, 768]", "[1024, 16385]", "from 16 to 16384"},
        BadEdit{"{monitor: HDMI-1}", "{display: \":0\"}", "expected sim, none"},
        BadEdit{"{monitor: HDMI-1}", "tv", "expected sim, none"},
        BadEdit{"{driver: pjlink, ", "{", "\"driver\" is missing"},
        BadEdit{"density_exponent: 2", "density_exponent: 17", "from 0 to 16"},
        BadEdit{"density_exponent: 2", "uniformity: 1.5", "from 0 to 1"},
        BadEdit{"density_exponent: 2", "stack: both", "expected share or left-right, found"},
        BadEdit{"density_exponent: 2", "priority_feather: -1", "from 0 to 4096"},
        BadEdit{"density_exponent: 2", "black: grey", "expected native or even, found"},
        BadEdit{"aspect: any", "aspect: 16x9", "expected any or W:H"},
        BadEdit{"aspect: any", "aspect: 16:0", "expected any or W:H"},
        BadEdit{"density: mean", "density: dense", "density: expected a number"},
        BadEdit{"density: mean", "density: -1", "density: expected a number"},
        BadEdit{"density: mean", "filter: cubic", "expected catmull-rom, bilinear or nearest, found \"cubic\""},
        BadEdit{"density: mean", "filter_domain: light", "expected srgb or linear, found \"light\""},
        BadEdit{"density: mean", "filter: [nearest]", "expected catmull-rom, bilinear or nearest, found"},
        BadEdit{"display: {aspect", "transfer: gamma\ndisplay: {aspect", "expected srgb or linear"},
        BadEdit{"display: {aspect", "displai: {aspect", "did you mean \"display\"?"},
        BadEdit{"units: mm", "units: mm\n  units: mm", "the key \"units\" is given twice"},
        BadEdit{"units: mm", "units: &a mm", "anchors are not supported"},
        BadEdit{"units: mm", "units: !foo mm", "tags are not supported"},
        BadEdit{"units: mm", "units: [mm]", "units: expected a text"},
        BadEdit{"  units: mm", "\tunits: mm", "a tab in the indentation"}));

TEST(StoreWall, NeedsEachFlatScreenOrNone) {
  calib::Wall wall = flatWall(2, 1);
  wall.projectors[1].flatAt.reset();
  EXPECT_THAT(wallProblems(formatWall(wall)), ElementsAre(::testing::HasSubstr("either all or none")));
}

TEST(StoreWall, RefusesAFlatScreenBeyondTheLargestDesktop) {
  calib::Wall wall = flatWall(1, 1);
  wall.projectors[0].flatAt = glm::ivec2(32768 - 1023, 0);
  EXPECT_THAT(wallProblems(formatWall(wall)), ElementsAre(::testing::HasSubstr("beyond pixel 32768")));
  wall.projectors[0].flatAt = glm::ivec2(32768 - 1024, 32768 - 768);
  EXPECT_THAT(wallProblems(formatWall(wall)), IsEmpty());
}

TEST(StoreWall, AFlatWallNeedsNoFiducials) {
  EXPECT_THAT(wallProblems(formatWall(flatWall(2, 2))), IsEmpty());
}

TEST(StoreWall, RefusesMoreProjectorsThanItCanHold) {
  EXPECT_THAT(wallProblems(formatWall(flatWall(8, 8))), IsEmpty());
  EXPECT_THAT(wallProblems(formatWall(flatWall(5, 13))),
              ElementsAre(::testing::HasSubstr("expected a list of 1 to 64")));
}

}  // namespace
}  // namespace pixelflex::testing
