#include <gmock/gmock.h>

#include <functional>
#include <ostream>

#include "calib/procedure/verdicts.h"
#include "tests/support_calibration/plain_wall.h"
#include "tests/unit/store_values.h"

namespace pixelflex::calib {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::vector<Finding> judged(const PlainWall& plain) {
  return judge(plain.wall, plain.calibration, summarise(plain.wall, plain.calibration));
}

void moveTo(ProjectorCalibration& projector, double left, double top = 0, double density = 1) {
  projector.model.projectorFromWall = {density, 0, -density * left, 0, density, -density * top, 0, 0, 1};
  for (auto& sample : projector.samples) {
    sample.pointInWall = sample.pointInProjector / density + glm::dvec2(left, top);
  }
}

/// One fault, and what is said of it.
struct Fault {
  const char* name;
  std::function<void(PlainWall&)> make;
  Severity severity;
  const char* where;
  const char* what;
};
std::ostream& operator<<(std::ostream& out, const Fault& fault) {
  return out << fault.name;
}

ProjectorCalibration& second(PlainWall& plain) {
  return plain.calibration.projectors[1];
}

const Severity kNotice = Severity::kNotice;
const Severity kBad = Severity::kBad;

const std::vector<Fault> kFaults = {
    {"BlurredBoards", [](PlainWall& w) { w.calibration.camera->rmsPx = 0.7; }, kNotice, "camera", "0.70 camera pixels"},
    {"UselessBoards", [](PlainWall& w) { w.calibration.camera->rmsPx = 2; }, kBad, "camera", "2.00 camera pixels"},
    {"FewBoards", [](PlainWall& w) { w.calibration.camera->photos = 5; }, kNotice, "camera", "only 5 checkerboard"},
    {"FiducialsOff", [](PlainWall& w) { w.calibration.surface->rms = 3; }, kNotice, "surface", "3.00 mm"},
    {"FiducialsWrong", [](PlainWall& w) { w.calibration.surface->rms = 30; }, kBad, "surface", "30.0 projector pixels"},
    {"SomeBlobsGone", [](PlainWall& w) { second(w).quality.found = 85; }, kNotice, "p2", "85 of 100"},
    {"ManyBlobsGone", [](PlainWall& w) { second(w).quality.found = 62; }, kBad, "p2", "62 of 100"},
    {"LargeResidual", [](PlainWall& w) { second(w).quality.rms = 0.4; }, kNotice, "p2", "leaves 0.40 px"},
    {"HugeResidual", [](PlainWall& w) { second(w).quality.rms = 0.9; }, kBad, "p2", "leaves 0.90 px"},
    {"Outlier", [](PlainWall& w) { second(w).quality.maximum = 2; }, kNotice, "p2", "one point is 2.00 px off"},
    {"HeldOut", [](PlainWall& w) { second(w).quality.heldOut = 0.2; }, kNotice, "p2", "missed by 0.20 px"},
    {"CoarseCamera", [](PlainWall& w) { second(w).quality.cameraScale = 0.1; }, kNotice, "p2", "0.10 camera pixels"},
    {"Nudge",
     [](PlainWall& w) {
       second(w).nudge = Nudge{{1.5, 0}, 0, {}};
     },
     kNotice, "p2", "corrected by hand: +1.50"},
    {"NotCalibrated", [](PlainWall& w) { w.calibration.projectors.pop_back(); }, kBad, "p2", "not calibrated"},
    {"OtherResolution",
     [](PlainWall& w) {
       w.wall.projectors[1].resolution = {800, 600};
     },
     kBad, "p2", "wall.yaml says 800x600"},
    {"Outside", [](PlainWall& w) { moveTo(second(w), 5000); }, kBad, "p2", "outside the display"},
    {"Island", [](PlainWall& w) { moveTo(second(w), 5000); }, kNotice, "wall", "falls into 2 parts"},
    {"Unlit", [](PlainWall& w) { moveTo(second(w), 850, 100); }, kBad, "display", "not lit"},
    {"NarrowBlend", [](PlainWall& w) { moveTo(second(w), 980); }, kNotice, "p1 and p2", "overlap by 2.0 %"},
    {"Density", [](PlainWall& w) { moveTo(second(w), 850, 0, 2); }, kNotice, "p1 and p2", "2.0 times"},
    {"Soft",
     [](PlainWall& w) {
       w.calibration.display->resolution = {3660, 1960};
     },
     kNotice, "p1", "0.50 projector pixels"},
    {"Seam", [](PlainWall& w) { second(w).quality.deviation = 0.3; }, kNotice, "p1 and p2", "expected seam error"},
    {"LittleUsed",
     [](PlainWall& w) {
       w.calibration.display = Display{10, 10, 500, 500, {490, 490}};
     },
     kNotice, "display", "uses 13 %"},
    {"StepMissing", [](PlainWall& w) { w.calibration.steps.erase("gamma"); }, kNotice, "wall", "no result of gamma"},
};

class Faults : public ::testing::TestWithParam<Fault> {};

TEST_P(Faults, IsNamedWithCauseAndCure) {
  PlainWall plain;
  GetParam().make(plain);
  const auto findings = judged(plain);
  EXPECT_THAT(findings,
              Contains(AllOf(Field(&Finding::severity, GetParam().severity), Field(&Finding::where, GetParam().where),
                             Field(&Finding::what, HasSubstr(GetParam().what)))));
  for (const auto& finding : findings) {
    EXPECT_FALSE(finding.cause.empty()) << finding.what;
    EXPECT_FALSE(finding.cure.empty()) << finding.what;
  }
}

INSTANTIATE_TEST_SUITE_P(Verdicts, Faults, ::testing::ValuesIn(kFaults),
                         [](const auto& fault) { return std::string(fault.param.name); });

TEST(Verdicts, NothingIsSaidOfAGoodWall) {
  const PlainWall plain;
  EXPECT_THAT(judged(plain), IsEmpty());
  const Summary summary = summarise(plain.wall, plain.calibration);
  EXPECT_THAT(verdict(summary, {}), AllOf(StartsWith("Good: 2 projectors"), HasSubstr("within 0.0")));
}

TEST(Verdicts, NothingIsSaidOnTheGoodSideOfEachBound) {
  PlainWall plain;
  plain.calibration.camera->rmsPx = 0.49;
  plain.calibration.camera->photos = 8;
  plain.calibration.surface->rms = 1.9;
  auto& quality = second(plain).quality;
  quality = {.rms = 0.1, .p95 = 0.2, .maximum = 0.5, .found = 90, .shown = 100};
  quality.heldOut = 0.17;
  quality.deviation = 0.1;
  quality.cameraScale = 0.2;
  second(plain).nudge = Nudge{};
  EXPECT_THAT(judged(plain), IsEmpty());
}

TEST(Verdicts, KnownIntrinsicsNeedNoBoards) {
  PlainWall plain;
  plain.calibration.camera->photos = 0;
  plain.calibration.camera->rmsPx = 0;
  EXPECT_THAT(judged(plain), IsEmpty());
}

TEST(Verdicts, BadOnesComeFirstAndOpenTheSentence) {
  PlainWall plain;
  plain.calibration.camera->photos = 5;
  second(plain).quality.found = 50;
  const auto findings = judged(plain);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].severity, Severity::kBad);
  const Summary summary = summarise(plain.wall, plain.calibration);
  EXPECT_EQ(verdict(summary, findings), "Not good yet: p2 (50 of 100 points found (50 %)), and 1 more.");
  EXPECT_THAT(verdict(summary, {findings[1]}), StartsWith("Usable, but look at camera (only 5"));
}

TEST(Verdicts, AnExactFlatWallIsGood) {
  const Wall wall = testing::flatWall(3, 2);
  const Calibration calibration = flatCalibration(wall);
  const Summary summary = summarise(wall, calibration);
  EXPECT_THAT(judge(wall, calibration, summary), IsEmpty());
  EXPECT_EQ(verdict(summary, {}), "Good: 6 projectors calibrated.");
}

TEST(Verdicts, CommandsStandAtTheEndOfACure) {
  for (const auto& fault : kFaults) {
    PlainWall plain;
    fault.make(plain);
    for (const auto& finding : judged(plain)) {
      const auto command = finding.cure.find("pixelflex ");
      if (command == std::string::npos) continue;
      EXPECT_EQ(finding.cure.find_first_of(",;", command), std::string::npos) << finding.cure;
    }
  }
}

TEST(Summary, OverlapsAndNeighbours) {
  const PlainWall plain(3);
  const Summary summary = summarise(plain.wall, plain.calibration);
  ASSERT_EQ(summary.projectors.size(), 3u);
  EXPECT_NEAR(summary.projectors[0].overlapPercent, 15, 1.1);
  EXPECT_NEAR(summary.projectors[1].overlapPercent, 30, 1.1);
  EXPECT_EQ(summary.projectors[1].neighbours, (std::vector<std::string>{"p1", "p3"}));
  EXPECT_NEAR(summary.projectors[1].displayPercent, 98, 0.1);
  EXPECT_NEAR(summary.projectors[1].desktopDensity, 1, 1e-6);
  EXPECT_EQ(summary.seams.size(), 2u);
}

}  // namespace
}  // namespace pixelflex::calib
