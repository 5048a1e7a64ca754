#include <gmock/gmock.h>

#include <regex>

#include "calib/report/heat_map.h"

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;

std::optional<double> rising(glm::dvec2 point) {
  return 0.8 + 0.4 * point.x / 100;
}

TEST(HeatMap, TheLineAtOneStandsWhereTheDensityIsOne) {
  const HeatMap map({0, 0}, {100, 50}, 40, rising);
  const std::string svg = map.svg(1);
  static const std::regex kPoint(R"rx([ML]([0-9.]+) )rx");
  const std::string path =
      svg.substr(svg.find("class=\"iso\" d=\""), svg.find("stroke-width") - svg.find("class=\"iso\""));
  int points = 0;
  for (std::sregex_iterator it(path.begin(), path.end(), kPoint), end; it != end; ++it, ++points) {
    EXPECT_NEAR(std::stod((*it)[1]), 50, 0.11);
  }
  EXPECT_EQ(points, 2 * 19) << "one segment between each two of twenty rows";
}

TEST(HeatMap, BoundsAndHoles) {
  const HeatMap map({0, 0}, {100, 50}, 40,
                    [](glm::dvec2 point) { return point.x < 50 ? rising(point) : std::nullopt; });
  EXPECT_NEAR(map.least(), 0.805, 1e-9);
  EXPECT_NEAR(map.most(), 0.995, 1e-9);
  EXPECT_THAT(map.svg(1), HasSubstr("class=\"iso\" d=\"\""));
  EXPECT_TRUE(HeatMap({0, 0}, {1, 1}, 8, [](glm::dvec2) { return std::nullopt; }).empty());
}

}  // namespace
}  // namespace pixelflex::calib
