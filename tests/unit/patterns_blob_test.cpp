#include "tests/unit/blob_photographs.h"

#include <random>

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;

TEST(BlobDecoder, FindsEveryBlobToAHundredthOfAPixel) {
  const DecodedBlobs decoded = decode(good());
  ASSERT_EQ(decoded.blobs.size(), 100u);
  EXPECT_TRUE(decoded.problems.empty()) << decoded.problems.front().seen;
  EXPECT_TRUE(decoded.hint.empty());
  EXPECT_LT(errorOf(decoded), 0.02);
  EXPECT_NEAR(decoded.cameraScale, 0.72, 0.03);
  for (int i = 0; i < 100; ++i) {
    const DecodedBlob& blob = decoded.blobs[static_cast<std::size_t>(i)];
    EXPECT_EQ(blob.id, i + 1);
    EXPECT_GT(blob.confidence, 0.9);
    EXPECT_LT(blob.error, 0.02);
  }
}

TEST(BlobDecoder, BlurIsNamedWhereItIs) {
  PatternPhotos photos = good();
  for (auto& photo : photos) blur(photo, 3);
  expectProblem(decode(photos), {Pattern::kBlobs}, "blurred", true);
  photos = good();
  blur(at(photos, Pattern::kBlobs), 4);
  expectProblem(decode(photos), {Pattern::kBlobs}, "flatter than those of the code photographs", true);
  photos = good();
  blur(at(photos, Pattern::kWhite), 4);
  expectProblem(decode(photos), {Pattern::kWhite}, "edges", true);
}

TEST(BlobDecoder, AnUnsharpCodePhotographDoesNoHarm) {
  PatternPhotos photos = good();
  blur(at(photos, Pattern::kBit3), 4);
  const DecodedBlobs decoded = decode(photos);
  expectProblem(decoded, {Pattern::kBit3}, "blurred", false);
  EXPECT_EQ(decoded.blobs.size(), 100u);
  EXPECT_LT(errorOf(decoded), 0.02);
}

TEST(BlobDecoder, ALittleBlurOfAllCostsLittle) {
  PatternPhotos photos = good();
  for (auto& photo : photos) blur(photo, 1);
  const DecodedBlobs decoded = decode(photos);
  EXPECT_FALSE(decoded.unusable());
  EXPECT_EQ(decoded.blobs.size(), 100u);
  EXPECT_LT(errorOf(decoded), 0.025);
}

TEST(BlobDecoder, DarknessIsRefusedBeforeItCostsMuch) {
  const auto darkened = [](double factor) {
    PatternPhotos photos = good();
    std::minstd_rand random(4);
    std::uniform_real_distribution<float> noise(-0.7F, 0.7F);
    for (auto& photo : photos) {
      change(photo, [&](int, int, double code) { return code * factor + noise(random); });
    }
    return photos;
  };
  expectProblem(decode(darkened(0.03)), {Pattern::kBlobs}, "too dark", true);
  expectProblem(decode(darkened(0.005)), {Pattern::kWhite}, "no brighter than black", true);
  for (const double factor : {0.06, 0.1}) {  // what is let through is good
    const DecodedBlobs decoded = decode(darkened(factor));
    if (!decoded.unusable()) {
      EXPECT_LT(errorOf(decoded), 0.12) << factor;
    }
  }
  EXPECT_FALSE(decode(darkened(0.1)).unusable());
}

TEST(BlobDecoder, OverExposureIsLocated) {
  PatternPhotos photos = good();
  for (auto& photo : photos) {
    change(photo, [](int x, int, double code) { return x < 350 ? code * 3 : code; });
  }
  expectProblem(decode(photos), {Pattern::kWhite}, "over-exposed", true);
  EXPECT_THAT(decode(photos).problems.front().seen, HasSubstr("left of the photograph"));
}

TEST(BlobDecoder, GoesOnWithoutTheBlobsBehindAPerson) {
  PatternPhotos photos = good();
  for (auto& photo : photos) hide(photo, 300, 250, 340, 500);
  const DecodedBlobs decoded = decode(photos);
  expectProblem(decoded, {Pattern::kBlobs}, "blobs are not seen, mostly left", false);
  EXPECT_THAT(decoded.problems.front().advice, HasSubstr("goes on with the other 9"));
  EXPECT_GE(decoded.blobs.size(), 90u);
  EXPECT_LT(errorOf(decoded), 0.03);
}

TEST(BlobDecoder, APersonInOneCodePhotographChangesNothing) {
  PatternPhotos photos = good();
  hide(at(photos, Pattern::kBit2), 300, 250, 340, 500);
  const DecodedBlobs decoded = decode(photos);
  expectProblem(decoded, {Pattern::kBit2}, "against their places", false);
  EXPECT_EQ(decoded.blobs.size(), 100u);
  EXPECT_LT(errorOf(decoded), 0.02);
  EXPECT_EQ(std::ranges::min(decoded.blobs, {}, &DecodedBlob::confidence).confidence, 0);
}

TEST(BlobDecoder, HalfABlobIsLeftOut) {
  PatternPhotos photos = good();
  for (int left = 250; left < 300; left += 9) {
    PatternPhotos cut = photos;
    hide(at(cut, Pattern::kBlobs), left, 200, left + 30, 500);
    const DecodedBlobs decoded = decode(cut);
    EXPECT_GE(decoded.blobs.size(), 80u) << left;
    EXPECT_LT(errorOf(decoded), 0.05) << left;
  }
}

TEST(BlobDecoder, RefusesWhatDoesNotHoldTheFrame) {
  PatternPhotos photos = good();
  for (auto& photo : photos) hide(photo, 100, 100, 330, 600);
  expectProblem(decode(photos), {Pattern::kBlobs}, "of 100 blobs are not seen", true);
  photos = good();
  hide(at(photos, Pattern::kBlobs), 100, 100, 230, 600);  // only there: white shows that the screen goes on
  expectProblem(decode(photos), {Pattern::kBlobs}, "frame's left side", true);
}
}  // namespace
}  // namespace pixelflex::calib
