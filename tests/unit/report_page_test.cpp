#include <gmock/gmock.h>

#include <fstream>
#include <regex>

#include "calib/report/html_text.h"
#include "calib/report/report.h"
#include "calib/store/store.h"
#include "devices/image/png_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/support_calibration/plain_wall.h"
#include "tests/unit/report_html.h"
#include "tests/unit/store_values.h"

namespace pixelflex::calib {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string page(const fs::path& folder, const PlainWall& plain) {
  return reportHtml(folder, plain.wall, plain.calibration, summarise(plain.wall, plain.calibration));
}

void photograph(const fs::path& file, const PlainWall& plain) {
  devices::Image8 photo(plain.calibration.camera->size, 3);
  for (int x = 0; x < photo.width(); ++x) photo.at(x, x % photo.height()) = 200;
  devices::writePng(file, photo);
}

class ReportPage : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
};

TEST_F(ReportPage, IsWellFormedAndFetchesNothing) {
  const PlainWall plain(3);
  for (const auto& config : plain.wall.projectors) {
    photograph(folder_ / "captures" / config.name / "blobs.png", plain);
  }
  const std::string html = page(folder_.path(), plain);
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(fetched(html), IsEmpty());
  EXPECT_THAT(html, Not(HasSubstr("http")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST_F(ReportPage, NamesEveryProjectorAndEveryOverlap) {
  const std::string html = page(folder_.path(), PlainWall(4));
  for (const auto* name : {"p1", "p2", "p3", "p4"})
    EXPECT_THAT(html, HasSubstr(std::string("</span>") + name + "</h3>"));
  EXPECT_EQ(count(html, "</span>p1 and <span"), 1u);
  EXPECT_EQ(count(html, "</span>p2 and <span"), 1u);
  EXPECT_EQ(count(html, "</span>p3 and <span"), 1u);
  EXPECT_THAT(html, HasSubstr("desktop 3530 × 980</text>"));
}

TEST_F(ReportPage, NamesAreText) {
  PlainWall plain;
  const std::string name = "<b>\"&'";
  plain.wall.projectors[1].name = name;
  plain.calibration.projectors[1].name = name;
  plain.calibration.projectors[1].quality.found = 50;
  plain.wall.surface.units = "<i>";
  const std::string html = page(folder_.path(), plain);
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
  EXPECT_THAT(html, Not(HasSubstr("<i>")));
  EXPECT_THAT(html, HasSubstr("&lt;b&gt;&quot;&amp;&#39;"));
}

TEST_F(ReportPage, RingsStandWhereTheCameraSawTheBlobsAndCrossesWhereOneIsMissing) {
  PlainWall plain;
  auto& samples = plain.calibration.projectors[0].samples;
  samples.erase(samples.begin() + 44);  // at (450, 450) of the frame, (550, 500) of the photograph
  photograph(folder_ / "captures/p1/blobs.png", plain);
  const std::string html = page(folder_.path(), plain);
  EXPECT_THAT(html, HasSubstr("data:image/jpeg;base64,"));
  EXPECT_EQ(count(html, "<circle"), 99u);
  EXPECT_THAT(html, HasSubstr("<circle cx=\"150.0\" cy=\"100.0\""));  // the first, at (50, 50)
  EXPECT_THAT(html, Not(HasSubstr("<circle cx=\"550.0\" cy=\"500.0\"")));
  static const std::regex kCross(R"rx(class="missing" d="M([0-9.]+) ([0-9.]+)l([0-9.]+) )rx");
  std::smatch cross;
  ASSERT_TRUE(std::regex_search(html, cross, kCross));
  EXPECT_NEAR(std::stod(cross[1]) + std::stod(cross[3]) / 2, 550, 0.2);
  EXPECT_NEAR(std::stod(cross[2]) + std::stod(cross[3]) / 2, 500, 0.2);
}

TEST_F(ReportPage, TakesThePlaceThatSeesTheProjectorLargest) {
  PlainWall plain;
  // From the second place the camera sees the wall at half the size, moved.
  plain.calibration.places.push_back({.wallFromCamera = {2, 0, -600, 0, 2, -100, 0, 0, 1}, .rms = 0.1});
  photograph(folder_ / "captures/place2/p1/blobs.png", plain);
  EXPECT_THAT(page(folder_.path(), plain), HasSubstr("<circle cx=\"325.0\" cy=\"75.0\""));
  photograph(folder_ / "captures/place1/p1/blobs.png", plain);
  EXPECT_THAT(page(folder_.path(), plain), HasSubstr("<circle cx=\"150.0\" cy=\"100.0\""));
}

TEST_F(ReportPage, DamagedOrMissingPhotographsAreLeftOut) {
  const PlainWall plain;
  fs::create_directories(folder_ / "captures/p1");
  std::ofstream(folder_ / "captures/p1/blobs.png") << "no picture";
  const std::string html = page(folder_.path(), plain);
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(html, Not(HasSubstr("data:image/jpeg")));
  EXPECT_THAT(html, HasSubstr("Residuals of p1"));
}

TEST_F(ReportPage, DenseMeasurementsAreDotsOverTheWhitePhotograph) {
  PlainWall plain;
  auto& projector = plain.calibration.projectors[0];
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 p(100 + 9 * i, 500.5);
    projector.samples.push_back({p, p});
  }
  projector.quality.found = projector.quality.shown = static_cast<int>(projector.samples.size());
  photograph(folder_ / "captures/p1/dense-white.png", plain);
  const std::string html = page(folder_.path(), plain);
  EXPECT_EQ(count(html, "<circle"), 0u);
  EXPECT_THAT(html, HasSubstr("class=\"found dot\" d=\"M150.0 100.0h0"));
}

TEST_F(ReportPage, SaysWhatIsWrongWithCauseAndCure) {
  PlainWall plain;
  plain.calibration.projectors[1].quality.found = 50;
  const std::string html = page(folder_.path(), plain);
  EXPECT_THAT(html, HasSubstr("Not good yet: p2 (50 of 100 points found"));
  EXPECT_THAT(html, HasSubstr("<dt>Cause</dt>"));
  EXPECT_THAT(html, HasSubstr("<code>pixelflex calibrate WALL --only p2</code>"));
}

TEST_F(ReportPage, OfAFlatWallAndOfAWallWithoutCalibration) {
  const Wall flat = testing::flatWall(2, 2);
  const Calibration exact = flatCalibration(flat);
  const std::string html = reportHtml(folder_.path(), flat, exact, summarise(flat, exact));
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(html, HasSubstr("Good: 4 projectors calibrated."));
  EXPECT_THAT(html, HasSubstr("No two projectors overlap."));

  const Wall wall = testing::exampleWall();
  const std::string empty = reportHtml(folder_.path(), wall, {}, summarise(wall, {}));
  EXPECT_EQ(nestingProblem(empty), "");
  EXPECT_THAT(empty, HasSubstr("not calibrated"));
}

TEST_F(ReportPage, ABentScreenIsShownFromAboveToo) {
  PlainWall plain;
  EXPECT_THAT(page(folder_.path(), plain), Not(HasSubstr("from above")));
  plain.calibration.surface->bend = Bend{.radius = 3000, .apex = 900, .depth = {0, 0, 1e-4}};
  const std::string html = page(folder_.path(), plain);
  EXPECT_THAT(html, HasSubstr("The bent screen from above"));
  EXPECT_EQ(nestingProblem(html), "");
}

TEST(ReportText, RoundedDown) {
  EXPECT_EQ(plain(roundedDown(0.0734)), "0.05");
  EXPECT_EQ(plain(roundedDown(2.1)), "2");
  EXPECT_EQ(plain(roundedDown(1999)), "1000");
}

}  // namespace
}  // namespace pixelflex::calib
