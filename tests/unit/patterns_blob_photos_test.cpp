#include "tests/unit/blob_photographs.h"

namespace pixelflex::calib {
namespace {

using ::testing::HasSubstr;

TEST(BlobDecoder, SwappedBitsAreBothNamed) {
  PatternPhotos photos = good();
  std::swap(at(photos, Pattern::kBit2), at(photos, Pattern::kBit4));
  expectProblem(decode(photos), {Pattern::kBit2, Pattern::kBit4}, "swapped", true);
}

TEST(BlobDecoder, BlobsSwappedWithABitAreBothNamed) {
  PatternPhotos photos = good();
  std::swap(at(photos, Pattern::kBlobs), at(photos, Pattern::kBit5));
  expectProblem(decode(photos), {Pattern::kBlobs, Pattern::kBit5}, "swapped", true);
}

TEST(BlobDecoder, BlackAndWhiteSwappedWithAnyAreBothNamed) {
  PatternPhotos photos = good();
  std::swap(at(photos, Pattern::kBlack), at(photos, Pattern::kWhite));
  expectProblem(decode(photos), {Pattern::kBlack, Pattern::kWhite}, "swapped", true);
  photos = good();
  std::swap(at(photos, Pattern::kWhite), at(photos, Pattern::kBlobs));
  expectProblem(decode(photos), {Pattern::kWhite, Pattern::kBlobs}, "swapped", true);
  photos = good();
  std::swap(at(photos, Pattern::kBlack), at(photos, Pattern::kBit1));
  expectProblem(decode(photos), {Pattern::kBlack, Pattern::kBit1}, "swapped", true);
}

TEST(BlobDecoder, APictureUnderTwoNamesIsNoticed) {
  PatternPhotos photos = good();
  at(photos, Pattern::kBit6) = at(photos, Pattern::kBit0);
  expectProblem(decode(photos), {Pattern::kBit0, Pattern::kBit6}, "one and the same photograph", true);
  // Photographed twice while the same picture was shown.
  change(at(photos, Pattern::kBit6),
         [](int x, int y, double code) { return code + ((x * 7 + y * 13) % 3 == 0 ? 1 : 0); });
  expectProblem(decode(photos), {Pattern::kBit6}, "the picture of bit0", true);
}

TEST(BlobDecoder, AnotherProjectorsPictureIsNamed) {
  for (const Pattern pattern : {Pattern::kBlobs, Pattern::kBit0, Pattern::kBit3, Pattern::kBit6}) {
    PatternPhotos photos = good();
    at(photos, pattern) = ofTheOther()[indexOf(pattern)];
    expectProblem(decode(photos), {pattern}, "outside this projector's frame", true);
  }
  PatternPhotos photos = good();
  at(photos, Pattern::kWhite) = ofTheOther()[indexOf(Pattern::kWhite)];
  expectProblem(decode(photos), {Pattern::kWhite}, "another projector's white", true);
}

TEST(BlobDecoder, RoomLightIsNoticed) {
  for (const Pattern pattern : {Pattern::kBlack, Pattern::kWhite, Pattern::kBlobs}) {
    PatternPhotos photos = good();
    change(at(photos, pattern), [](int, int, double code) { return code + 40; });
    expectProblem(decode(photos), {pattern}, "brighter than", true);
  }
  PatternPhotos photos = good();
  change(at(photos, Pattern::kBit3), [](int, int, double code) { return code + 40; });
  const DecodedBlobs decoded = decode(photos);
  expectProblem(decoded, {Pattern::kBit3}, "room light", false);
  EXPECT_EQ(decoded.blobs.size(), 100u);
  photos = good();
  for (auto& photo : photos) change(photo, [](int, int, double code) { return code + 20; });
  EXPECT_TRUE(decode(photos).problems.empty());  // always on: black takes it away
}

TEST(BlobDecoder, AnotherExposureIsNoticed) {
  PatternPhotos photos = good();
  change(at(photos, Pattern::kBit2), [](int, int, double code) { return code * 0.4; });
  const DecodedBlobs decoded = decode(photos);
  expectProblem(decoded, {Pattern::kBit2}, "exposed differently", false);
  EXPECT_EQ(decoded.blobs.size(), 100u);
  photos = good();
  change(at(photos, Pattern::kBlobs), [](int, int, double code) { return code * 0.6; });
  expectProblem(decode(photos), {Pattern::kBlobs}, "exposed differently", true);
}

TEST(BlobDecoder, AMovedCameraIsMeasured) {
  PatternPhotos photos = good();
  for (int bit = 3; bit < kCodeBits; ++bit) shift(at(photos, bitPattern(bit)), 3, -4);
  expectProblem(decode(photos), {Pattern::kBit3}, "from this photograph on", true);
  EXPECT_THAT(decode(photos).problems.front().seen, HasSubstr("5 camera pixels"));
  photos = good();
  for (const Pattern pattern : allPatterns()) {
    if (pattern >= Pattern::kBlobs) shift(at(photos, pattern), 0, 1);
  }
  expectProblem(decode(photos), {Pattern::kWhite, Pattern::kBlobs}, "moved by 1.0 camera pixels", true);
  photos = good();
  shift(at(photos, Pattern::kBit4), 6, 0);
  expectProblem(decode(photos), {Pattern::kBit4}, "6 camera pixels beside", true);
}

TEST(BlobDecoder, ADifferentSizeIsNamed) {
  PatternPhotos photos = good();
  at(photos, Pattern::kBit1) = Image8({480, 300}, 3);
  expectProblem(decode(photos), {Pattern::kBit1}, "480x300", true);
}
}  // namespace
}  // namespace pixelflex::calib
