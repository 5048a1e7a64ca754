// By every path the same picture, also where the GPU reads the pixels itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "devices/display/gl_context.h"
#include "tests/gl/gl_test.h"
#include "tests/gl/plans.h"
#include "viewer/renderer/upload_memory.h"
#include "viewer/renderer/upload_path.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::viewer {
namespace {

using devices::Image8;
using devices::Size;
using Memory = UploadPath::Memory;
using Order = UploadPath::Order;

constexpr Size kDesktop{1500, 1100};  // four tiles
constexpr Size kFrame{400, 300};

std::vector<OutputPlan> oneOutput() {
  return {testing::planOf("p1", testing::homographyMap(kFrame, kDesktop), kFrame, kDesktop, 4, 3)};
}

/// Through a belt in the renderer's memory, whose pixels are spoilt as soon as they have been uploaded.
void uploadByBelt(WallRenderer& renderer, FrameBelt& belt, const Image8& picture, const std::vector<Box>& boxes) {
  const Batch wanted = testing::batchOf(picture, boxes);
  Batch* batch = belt.acquire({});
  batch->desktop = wanted.desktop;
  batch->boxes = wanted.boxes;
  batch->pixels.assign(wanted.pixels.begin(), wanted.pixels.end());
  batch->completesUpdate = wanted.completesUpdate;
  renderer.upload(*batch);
  std::ranges::fill(batch->pixels, std::byte{0xA5});
  belt.release(batch);
}

class UploadPathTest : public testing::GlTest<::testing::TestWithParam<UploadPath>> {};

TEST_P(UploadPathTest, ShowsTheSamePicture) {
  const Image8 picture = testing::testDesktop(kDesktop);
  WallRenderer plain(context_);
  plain.setPlans(oneOutput());
  plain.upload(testing::wholeBatch(picture));
  plain.draw();

  WallRenderer renderer(context_, {.upload = GetParam()});
  EXPECT_EQ(renderer.uploadMemory() != nullptr, GetParam().memory == Memory::kMapped);
  FrameBelt belt(nullptr, renderer.uploadMemory());
  renderer.setPlans(oneOutput());
  for (const Box& box : {Box{0, 0, 1500, 400}, Box{0, 400, 1000, 1100}, Box{1000, 400, 1500, 1100}}) {
    uploadByBelt(renderer, belt, picture, {box});
  }
  uploadByBelt(renderer, belt, picture, {{3, 5, 70, 60}, {1010, 1000, 1100, 1090}});
  renderer.draw();
  EXPECT_EQ(renderer.readDesktop(), picture);
  EXPECT_EQ(renderer.readOutput(0), plain.readOutput(0));
}

TEST_P(UploadPathTest, MixesWithDesktopsDrawnOnTheGpu) {
  const Image8 picture = testing::testDesktop(kDesktop);
  WallRenderer source(context_);
  source.setPlans({testing::planOf("all", testing::homographyMap(kDesktop, kDesktop), kDesktop, kDesktop, 1, 1)});
  source.upload(testing::wholeBatch(picture));
  source.draw();
  WallRenderer renderer(context_, {.upload = GetParam()});
  FrameBelt belt(nullptr, renderer.uploadMemory());
  renderer.setPlans(oneOutput());
  uploadByBelt(renderer, belt, picture, {{0, 0, 64, 64}});
  renderer.copyDesktop(source.outputTexture(0));
  EXPECT_EQ(renderer.readDesktop(), source.readOutput(0));
  uploadByBelt(renderer, belt, picture, {{0, 0, 1500, 200}});
  const Image8 mixed = renderer.readDesktop();
  EXPECT_TRUE(std::ranges::equal(mixed.samples().first(1500 * 3 * 200), picture.samples().first(1500 * 3 * 200)));
}

INSTANTIATE_TEST_SUITE_P(All, UploadPathTest,
                         ::testing::Values(UploadPath{Order::kRgba, Memory::kClient},
                                           UploadPath{Order::kBgra, Memory::kClient},
                                           UploadPath{Order::kRgba, Memory::kMapped},
                                           UploadPath{Order::kBgra, Memory::kMapped}));

TEST(UploadPath, IsTheFastestButNotForLittle) {
  const UploadPath plain;
  const UploadPath mapped{Order::kRgba, Memory::kMapped};
  const UploadPath exchanged{Order::kBgra, Memory::kClient};
  EXPECT_EQ(fastestUpload({}), plain);
  EXPECT_EQ(fastestUpload(std::vector<UploadRate>{{plain, 1e9}, {mapped, 1.05e9}, {exchanged, 1e8}}), plain);
  EXPECT_EQ(fastestUpload(std::vector<UploadRate>{{plain, 1e9}, {mapped, 3e9}, {exchanged, 4e9}}), exchanged);
  EXPECT_EQ(describeUploads(std::vector<UploadRate>{{plain, 1e9}, {mapped, 3e9}}),
            "mapped buffer, RGBA 3.0 GB/s (client memory, RGBA 1.0)");
}

TEST(UploadPath, IsMeasuredByEveryWay) {
  devices::HeadlessContext context;
  const devices::GlDebugLog log;
  const auto rates = measureUploads(context);
  ASSERT_EQ(rates.size(), 4U);
  for (const auto& rate : rates) EXPECT_GT(rate.bytesPerSecond, 1e6);
}

TEST(UploadMemory, TakesFromTheHeapWhatDoesNotFit) {
  const devices::HeadlessContext context;
  UploadMemory memory;
  std::vector<PixelBytes> slots;
  for (std::size_t i = 0; i <= FrameBelt::kSlots; ++i) slots.emplace_back(FrameBelt::kMaxBytes, &memory);
  for (std::size_t i = 0; i < FrameBelt::kSlots; ++i) {
    EXPECT_EQ(memory.offsetOf(slots[i].data()), i * FrameBelt::kMaxBytes);
  }
  EXPECT_EQ(memory.offsetOf(slots.back().data()), std::nullopt);
  slots[1] = PixelBytes(&memory);
  EXPECT_EQ(memory.offsetOf(PixelBytes(FrameBelt::kMaxBytes, &memory).data()), FrameBelt::kMaxBytes);
  EXPECT_EQ(memory.offsetOf(PixelBytes(FrameBelt::kMaxBytes + 1, &memory).data()), std::nullopt);
}

}  // namespace
}  // namespace pixelflex::viewer
