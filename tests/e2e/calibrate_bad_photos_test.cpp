#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/store/store.h"
#include "devices/image/photo_file.h"
#include "devices/image/png_file.h"
#include "tests/e2e/mini_wall.h"
#include "tests/e2e/programs.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using devices::Image8;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// `to` gets x, y and a code, and gives another.
template <class To>
Image8 changed(Image8 photo, const To& to) {
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        photo.at(x, y, c) = static_cast<std::uint8_t>(std::clamp(std::lround(to(x, y, photo.at(x, y, c))), 0L, 255L));
      }
    }
  }
  return photo;
}

Image8 shifted(const Image8& photo, int dx, int dy) {
  Image8 result(photo.size(), 3);
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      const int u = std::clamp(x - dx, 0, photo.width() - 1);
      const int v = std::clamp(y - dy, 0, photo.height() - 1);
      for (int c = 0; c < 3; ++c) result.at(x, y, c) = photo.at(u, v, c);
    }
  }
  return result;
}

/// The mean of the square of (2 reach + 1)^2 pixels around each, three times: nearly a Gaussian.
Image8 blurred(Image8 photo, int reach) {
  for (int pass = 0; pass < 6; ++pass) {
    const Image8 from = photo;
    const int dx = pass % 2 == 0 ? 1 : 0;
    for (int y = 0; y < photo.height(); ++y) {
      for (int x = 0; x < photo.width(); ++x) {
        for (int c = 0; c < 3; ++c) {
          int sum = 0;
          for (int i = -reach; i <= reach; ++i) {
            sum += from.at(std::clamp(x + i * dx, 0, photo.width() - 1),
                           std::clamp(y + i * (1 - dx), 0, photo.height() - 1), c);
          }
          photo.at(x, y, c) = static_cast<std::uint8_t>((sum + reach) / (2 * reach + 1));
        }
      }
    }
  }
  return photo;
}

/// A wall calibrated once, and its photographs to be spoiled one way after the other.
class BadPhotosTest : public ::testing::Test {
 protected:
  void SetUp() override {
    makeMiniWall(wall());
    fs::copy(wall() / "captures", good(), fs::copy_options::recursive);
    stored_ = filesOf(wall());
    knowCamera();
    restore();
  }

  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  [[nodiscard]] fs::path good() const { return folder_ / "good"; }
  [[nodiscard]] fs::path photos() const { return folder_ / "photos"; }
  [[nodiscard]] fs::path photo(const std::string& name) const { return photos() / (name + ".png"); }

  /// Saves looking for checkerboards where they do not matter.
  void knowCamera() const {
    const auto camera = calib::loadCalibration(wall()).camera.value();
    const auto list = [](const auto& values) {
      std::string text;
      for (const double value : values) text += (text.empty() ? "" : ", ") + std::to_string(value);
      return "[" + text + "]\n";
    };
    writeText(good() / "camera.yaml", "size: [960, 600]\nfx: " + std::to_string(camera.fx) +
                                          "\nfy: " + std::to_string(camera.fy) + "\ncx: " + std::to_string(camera.cx) +
                                          "\ncy: " + std::to_string(camera.cy) + "\nradial: " + list(camera.radial) +
                                          "tangential: " + list(camera.tangential));
  }

  void restore() const {
    fs::remove_all(photos());
    fs::copy(good(), photos(), fs::copy_options::recursive);
  }

  template <class To>
  void change(const std::string& name, const To& to) const {
    put(name, changed(read(name), to));
  }
  [[nodiscard]] Image8 read(const std::string& name) const { return devices::readPhoto(photo(name)); }
  void put(const std::string& name, const Image8& image) const { devices::writePng(photo(name), image); }

  void swap(const std::string& one, const std::string& other) const {
    fs::rename(photo(one), photos() / "x");
    fs::rename(photo(other), photo(one));
    fs::rename(photos() / "x", photo(other));
  }

  [[nodiscard]] static std::map<std::string, std::string> filesOf(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) files[entry.path().string()] = textOf(entry.path());
    }
    return files;
  }

  /// Must fail, say all of this, and leave every file of the wall as it was; then the photographs are good again.
  void expectRefused(const std::vector<std::string>& words) {
    const Output run = runProgram("calibrate", {wall().string(), "--photos", photos().string()});
    EXPECT_EQ(run.status, 1) << run.text;
    for (const auto& word : words) EXPECT_THAT(run.text, HasSubstr(word));
    EXPECT_TRUE(filesOf(wall()) == stored_) << "the store has changed: " << words.front();
    restore();
  }

  /// Must succeed all the same, and say this.
  void expectWarned(const std::vector<std::string>& words) {
    const Output run = runProgram("calibrate", {wall().string(), "--photos", photos().string()});
    EXPECT_EQ(run.status, 0) << run.text;
    for (const auto& word : words) EXPECT_THAT(run.text, HasSubstr(word));
    for (const auto& projector : calib::loadCalibration(wall()).projectors) {
      EXPECT_LT(projector.quality.rms, 0.1) << projector.name;
    }
    restore();
  }

  const TemporaryFolder folder_;
  std::map<std::string, std::string> stored_;
};

TEST_F(BadPhotosTest, ExchangedAndForeignPhotographsAreNamed) {
  swap("p1/bit2", "p1/bit5");
  expectRefused({"p1/bit2.png, p1/bit5.png", "swapped"});
  swap("p2/blobs", "p2/bit0");
  expectRefused({"p2/blobs.png, p2/bit0.png", "swapped"});
  swap("p2/white", "p2/blobs");
  expectRefused({"p2/white.png, p2/blobs.png", "swapped"});
  fs::copy_file(photo("p2/bit3"), photo("p1/bit3"), fs::copy_options::overwrite_existing);
  expectRefused({"p1/bit3.png", "outside this projector's frame"});
  fs::copy_file(photo("p1/bit3"), photo("p1/bit4"), fs::copy_options::overwrite_existing);
  expectRefused({"p1/bit3.png, p1/bit4.png", "one and the same photograph"});
}

TEST_F(BadPhotosTest, UnsharpAndDarkPhotographsAreNamed) {
  put("p1/blobs", blurred(read("p1/blobs"), 3));
  expectRefused({"p1/blobs.png", "blurred", "focus"});
  put("p1/white", blurred(read("p1/white"), 3));
  expectRefused({"p1/white.png", "blurred"});
  for (const auto& entry : fs::directory_iterator(photos() / "p2")) {
    const std::string name = "p2/" + entry.path().stem().string();
    change(name, [](int x, int y, double code) { return 0.025 * code + ((x * 31 + y * 17) % 3 - 1) * 0.5; });
  }
  expectRefused({"p2/blobs.png", "too dark", "lengthen the exposure"});
}

TEST_F(BadPhotosTest, LightThatShouldNotBeThereIsNamed) {
  for (const auto& entry : fs::directory_iterator(photos() / "p1")) {
    change("p1/" + entry.path().stem().string(), [](int x, int, double code) { return x > 300 ? 3 * code : code; });
  }
  expectRefused({"p1/white.png", "over-exposed", "of the photograph", "shorten the exposure"});
  change("p2/blobs", [](int, int, double code) { return code + 30; });
  expectRefused({"p2/blobs.png", "room light", "dark"});
  change("p2/black", [](int, int, double code) { return code + 30; });
  expectRefused({"p2/black.png", "brighter than the others"});
}

TEST_F(BadPhotosTest, ACameraThatMovedHalfWayIsMeasured) {
  for (int bit = 2; bit < 7; ++bit) {
    const std::string name = "p1/bit" + std::to_string(bit);
    put(name, shifted(read(name), 4, 3));
  }
  expectRefused({"p1/bit2.png", "from this photograph on", "5 camera pixels", "touch neither"});
  for (const auto* name : {"p1/blobs", "p1/bit0", "p1/bit1", "p1/bit2", "p1/bit3", "p1/bit4", "p1/bit5", "p1/bit6"}) {
    put(name, shifted(read(name), 2, 0));
  }
  expectRefused({"p1/white.png, p1/blobs.png", "has moved by 2.0 camera pixels"});
}

TEST_F(BadPhotosTest, APersonBeforeTheWallCostsOnlyWhatTheyHide) {
  const auto behind = [](int x, int y, double code) {
    const double head = std::hypot(x - 330.0, y - 300.0);
    return head < 28 || (std::abs(x - 330) < 40 && y > 325) ? 2.0 : code;
  };
  for (const auto& entry : fs::directory_iterator(photos() / "p1")) {
    change("p1/" + entry.path().stem().string(), behind);
  }
  expectWarned({"p1/blobs.png", "blobs are not seen", "stands before the wall", "goes on with the other"});
}

TEST_F(BadPhotosTest, APersonBeforeMostOfAProjectorIsTooMuch) {
  for (const auto& entry : fs::directory_iterator(photos() / "p1")) {
    change("p1/" + entry.path().stem().string(), [](int x, int, double code) { return x < 360 ? 2.0 : code; });
  }
  expectRefused({"p1/blobs.png", "of 100 blobs are not seen", "stand"});
}

TEST_F(BadPhotosTest, FiducialsThatDoNotFitAreExplained) {
  const std::string yaml = textOf(wall() / "wall.yaml");
  const auto typed = [&](const std::string& from, const std::string& to) {
    ASSERT_THAT(yaml, HasSubstr(from));
    writeText(wall() / "wall.yaml", replaced(yaml, from, to));
    stored_ = filesOf(wall());
  };
  typed("at: [2302.5, 182.2]", "at: [2032.5, 182.2]");
  expectRefused({"fiducials.png", "fiducial 2 is measured as at: [2032, 182]", "seen at about [230", "mistyped?"});
  writeText(wall() / "wall.yaml", replaced(replaced(yaml, "aruco: 3,", "aruco: 9,"), "aruco: 5,", "aruco: 3,"));
  writeText(wall() / "wall.yaml", replaced(textOf(wall() / "wall.yaml"), "aruco: 9,", "aruco: 5,"));
  stored_ = filesOf(wall());
  expectRefused({"fiducials.png", "fiducials 5 ", "and 3 ", "exchanged"});
  writeText(wall() / "wall.yaml", yaml);
  Image8 covered = read("fiducials");
  for (int y = 60; y < 250; ++y) {  // a chair before one of them
    for (int x = 0; x < 260; ++x) {
      for (int c = 0; c < 3; ++c) covered.at(x, y, c) = 60;
    }
  }
  put("fiducials", covered);
  expectWarned({"fiducials.png", "markers not found: 0", "5 fiducials"});
}

TEST_F(BadPhotosTest, CheckerboardsThatAreAllAlikeAreRefused) {
  fs::remove(good() / "camera.yaml");
  restore();
  std::vector<fs::path> boards;
  for (const auto& entry : fs::directory_iterator(photos() / "checkerboard")) boards.push_back(entry.path());
  std::ranges::sort(boards);
  for (const auto& board : boards) {
    if (board != boards[4]) fs::copy_file(boards[4], board, fs::copy_options::overwrite_existing);
  }
  expectRefused({"camera: the checkerboard was found in 1 different photographs",
                 boards[1].filename().string() + " like ", "at least 3 are needed"});
}

}  // namespace
}  // namespace pixelflex::testing
