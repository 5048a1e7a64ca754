#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "devices/image/png_file.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using devices::Image8;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class ModelCliTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Output made = runProgram("new", {wall(), "--flat", "2x1:240x200"});
    ASSERT_EQ(made.status, 0) << made.text;
    writeText(folder_ / "solid.obj", kTetrahedron);
  }
  Output show(std::vector<std::string> more) {
    more.insert(more.begin(), {wall(), (folder_ / "solid.obj").string()});
    return runProgram("model", more);
  }
  [[nodiscard]] std::string wall() const { return (folder_ / "wall").string(); }
  [[nodiscard]] Image8 picture(const std::string& name) const { return devices::readPng8(folder_ / name); }
  TemporaryFolder folder_;
};

/// The largest difference of codes between the two screens side by side and the desktop.
int differenceToDesktop(const Image8& left, const Image8& right, const Image8& desktop) {
  EXPECT_EQ(desktop.width(), left.width() + right.width());
  int largest = 0;
  for (int y = 0; y < desktop.height(); ++y) {
    for (int x = 0; x < desktop.width(); ++x) {
      const auto& screen = x < left.width() ? left : right;
      for (int c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(screen.at(x % left.width(), y, c) - desktop.at(x, y, c)));
      }
    }
  }
  return largest;
}

int brightest(const Image8& image) {
  return *std::ranges::max_element(image.samples());
}

/// What stands out of the dark.
struct Silhouette {
  double aspect = 0;  // of the box around it
  double filled = 0;  // of that box
  int brightest = 0;
};

Silhouette silhouetteOf(const Image8& image) {
  int lit = 0;
  int left = image.width();
  int right = 0;
  int top = image.height();
  int bottom = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y, 1) < 35) continue;
      ++lit;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  }
  const double width = right - left;
  const double height = bottom - top;
  return {width / height, lit / (width * height), brightest(image)};
}

TEST_F(ModelCliTest, FlatScreensShowWhatOneCameraSees) {
  const auto shot = (folder_ / "shot").string();
  for (const std::string passes : {"1", "2"}) {
    const Output shown =
        show({"--headless", "--screenshot", shot, "--view", "30,20", "--samples", "1", "--passes", passes});
    ASSERT_EQ(shown.status, 0) << shown.text;
    EXPECT_THAT(shown.text, HasSubstr("4 triangles on 2 projectors"));
    EXPECT_THAT(shown.text, HasSubstr("0.00 px at most"));
    EXPECT_THAT(shown.text, Not(HasSubstr("seams")));
    EXPECT_GT(brightest(picture("shot/desktop.png")), 100);
    // Dither may move a code by one.
    EXPECT_LE(differenceToDesktop(picture("shot/p1.png"), picture("shot/p2.png"), picture("shot/desktop.png")), 1);
  }
}

TEST_F(ModelCliTest, ATurntableTurnsTheModel) {
  const auto turn = (folder_ / "turn").string();
  const Output shown = show({"--headless", "--screenshot", turn, "--turntable", "4"});
  ASSERT_EQ(shown.status, 0) << shown.text;
  EXPECT_FALSE(picture("turn/000/desktop.png") == picture("turn/001/desktop.png"));
  EXPECT_TRUE(fs::exists(folder_ / "turn/003/p2.png"));
  EXPECT_FALSE(fs::exists(folder_ / "turn/004"));
}

TEST_F(ModelCliTest, TheViewersPlaceAndCutsChangeThePicture) {
  const auto take = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--headless", "--screenshot", (folder_ / "s").string()});
    const Output shown = show(more);
    EXPECT_EQ(shown.status, 0) << shown.text;
    return picture("s/desktop.png");
  };
  const Image8 plain = take({"--view", "20,20"});
  EXPECT_FALSE(take({"--view", "20,20", "--eye", "200,50,400"}) == plain);
  EXPECT_FALSE(take({"--view", "20,20", "--wireframe"}) == plain);
  EXPECT_FALSE(take({"--view", "20,20", "--axes"}) == plain);
  EXPECT_FALSE(take({"--view", "20,20", "--cut", "1,0,0,0"}) == plain);
  EXPECT_EQ(brightest(take({"--view", "20,20", "--cut", "0,0,0,-1"})), 0);
  // Both halves show the model; the eyes' two pictures are not the same.
  const Image8 both = take({"--view", "20,20", "--stereo", "side-by-side", "--eye-distance", "80"});
  EXPECT_EQ(both.size(), plain.size());
  int unlike = 0;
  for (int x = 0; x < both.width() / 2; ++x)
    unlike += both.at(x, 100, 0) != both.at(x + both.width() / 2, 100, 0) ? 1 : 0;
  EXPECT_GT(unlike, 3);
  const Image8 anaglyph = take({"--view", "20,20", "--stereo", "anaglyph", "--eye-distance", "80"});
  EXPECT_FALSE(anaglyph == plain);
}

TEST_F(ModelCliTest, TheRoomIsWhatTheAudienceOfASimulatedWallSees) {
  const auto simulated = (folder_ / "simulated").string();
  const auto shot = (folder_ / "shot").string();
  ASSERT_EQ(runProgram("new", {simulated, "--rig", kMiniRig}).status, 0);
  const Output calibrated = runProgram("calibrate", {simulated});
  ASSERT_EQ(calibrated.status, 0) << calibrated.text;
  for (const std::string passes : {"1", "2"}) {
    const Output shown = runProgram("model", {simulated, (folder_ / "solid.obj").string(), "--headless", "--screenshot",
                                              shot, "--room", "--passes", passes, "--view", "30,20"});
    ASSERT_EQ(shown.status, 0) << shown.text;
    EXPECT_GT(brightest(picture("shot/p1.png")), 100);
    const Output composed =
        runProgram("simulate", {simulated, "--frames", shot, "--audience", (folder_ / "audience.png").string()});
    ASSERT_EQ(composed.status, 0) << composed.text;
    // They may show more or less of the wall around the model.
    const Silhouette room = silhouetteOf(picture("shot/room.png"));
    const Silhouette audience = silhouetteOf(picture("audience.png"));
    EXPECT_NEAR(room.aspect, audience.aspect, 0.02 * audience.aspect) << passes;
    EXPECT_NEAR(room.filled, audience.filled, 0.02) << passes;
    EXPECT_NEAR(room.brightest, audience.brightest, 12) << passes;
  }
  // A wall that is not simulated has no room.
  const Output none = show({"--headless", "--screenshot", shot, "--room"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.text, HasSubstr("rig: FILE"));
}

TEST_F(ModelCliTest, BadFilesAndWrongUseAreToldInWords) {
  writeText(folder_ / "empty.ply", "");
  const auto shot = (folder_ / "shot").string();
  const Output empty = show({(folder_ / "empty.ply").string(), "--headless", "--screenshot", shot});
  EXPECT_EQ(empty.status, 1);
  EXPECT_THAT(empty.text, HasSubstr("empty.ply: the file is empty"));
  EXPECT_FALSE(fs::exists(shot));
  const Output behind = show({"--headless", "--screenshot", shot, "--eye", "0,0,-5"});
  EXPECT_EQ(behind.status, 2);
  EXPECT_THAT(behind.text, HasSubstr("before the wall"));
  EXPECT_EQ(show({"--headless"}).status, 2);
  EXPECT_EQ(show({"--headless", "--screenshot", shot, "--view", "1,x"}).status, 2);
}

}  // namespace
}  // namespace pixelflex::testing
