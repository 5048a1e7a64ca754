#include <gmock/gmock.h>

#include <fstream>

#include "tests/unit/report_html.h"
#include "tests/unit/report_lit_wall.h"

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kViews = "<h2>As the audience sees it</h2>";

TEST(LightReport, ShowsTheAudiencesViewAndEveryOverlapAndFetchesNothing) {
  LitWall lit(3);
  lit.match();
  const std::string html = lit.page();
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(fetched(html), IsEmpty());
  EXPECT_THAT(html, HasSubstr(kViews));
  for (const auto* title : {"White", "Grey 128", "Black", "Ramp from black to white", "Text"}) {
    EXPECT_THAT(html, HasSubstr("alt=\"" + std::string(title) + ", not calibrated\""));
    EXPECT_THAT(html, HasSubstr("alt=\"" + std::string(title) + ", calibrated\""));
  }
  EXPECT_EQ(count(html, "data:image/jpeg;base64,"), 10u);
  EXPECT_EQ(count(html, "aria-label=\"Luminance across the overlap of "), 2u);
  EXPECT_EQ(count(html, "aria-label=\"Response of "), 3u);
  EXPECT_EQ(count(html, "<figcaption>Gain: "), 3u);
  EXPECT_LT(html.size(), 900'000u);
}

TEST(LightReport, SaysHowWellTheCameraMeasuredAResponse) {
  LitWall lit;
  EXPECT_THAT(lit.page(), Not(HasSubstr("by the camera to")));
  lit.plain.calibration.projectors[1].responseError = 0.0123;
  EXPECT_EQ(count(lit.page(), "nearest to the power 2.40, by the camera to 1.2 % of light."), 1u);
}

TEST(LightReport, WithoutMeasuredLightThePageIsWholeAndSaysNothingOfIt) {
  LitWall lit;
  lit.plain.calibration.projectors[1].measured.reset();
  lit.plain.calibration.projectors[0].response.reset();
  const std::string html = lit.page();
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(html, Not(HasSubstr(kViews)));
  EXPECT_EQ(count(html, "<dt>response</dt><dd>sRGB assumed</dd>"), 1u);
  EXPECT_EQ(count(html, "aria-label=\"Response of "), 1u);
}

TEST(LightReport, DamagedFilesAreLeftOut) {
  for (const auto* file : {"p1-white.png", "p2-alpha.png", "p2-response.csv", "p1-gain.png"}) {
    LitWall lit;
    lit.match();
    std::ofstream(lit.folder() / "calibration" / file) << "no picture, no readings";
    EXPECT_EQ(nestingProblem(lit.page()), "") << file;
  }
}

TEST(LightReport, BlackIsLeftOutWhereALeakIsNotKnown) {
  LitWall lit;
  lit.plain.calibration.projectors[1].measured.value().leak.reset();
  const std::string html = lit.page();
  EXPECT_THAT(html, HasSubstr("alt=\"White, calibrated\""));
  EXPECT_THAT(html, Not(HasSubstr("alt=\"Black, ")));
  EXPECT_THAT(html, Not(HasSubstr("<dt>Contrast</dt>")));
}

TEST(LightReport, NamesInItAreText) {
  LitWall lit;
  lit.plain.wall.projectors[1].name = lit.plain.calibration.projectors[1].name = "<b>\"&'";
  const std::string html = lit.page();
  EXPECT_EQ(nestingProblem(html), "");
  EXPECT_THAT(html, HasSubstr(kViews));
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace pixelflex::calib
