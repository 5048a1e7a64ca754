#include "viewer/renderer/upload_path.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory_resource>

#include "viewer/renderer/desktop_texture.h"
#include "viewer/renderer/upload_memory.h"

namespace pixelflex::viewer {
namespace {

using Order = UploadPath::Order;
using Memory = UploadPath::Memory;

constexpr UploadPath kPlain{Order::kRgba, Memory::kClient};
constexpr UploadPath kPaths[] = {
    kPlain, {Order::kBgra, Memory::kClient}, {Order::kRgba, Memory::kMapped}, {Order::kBgra, Memory::kMapped}};
constexpr int kExtent = kTileExtent - 2 * kTileApron;  // one tile
constexpr int kRepeats = 3;
constexpr double kClearlyFaster = 1.1;

/// The best of a few: whatever else the machine does makes an upload slower, never faster.
double secondsOf(const UploadPath& path, UploadMemory& memory) {
  const devices::Size size{kExtent, kExtent};
  DesktopTexture texture(size, TexelFormat::kRgba8, path.order, path.memory == Memory::kMapped ? &memory : nullptr);
  PixelBytes pixels(static_cast<std::size_t>(size.area()) * 4,
                    path.memory == Memory::kMapped ? &memory : std::pmr::new_delete_resource());
  const Box whole = boxOf(size);
  double best = 1e9;
  for (int i = 0; i <= kRepeats; ++i) {  // the first one warms up
    const auto begin = std::chrono::steady_clock::now();
    texture.upload(std::span(&whole, 1), pixels);
    glFinish();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    if (i > 0) best = std::min(best, took.count());
  }
  return std::max(best, 1e-9);
}

double rateOf(std::span<const UploadRate> rates, const UploadPath& path) {
  const auto found = std::ranges::find(rates, path, &UploadRate::path);
  return found == rates.end() ? 0 : found->bytesPerSecond;
}

std::string nameOf(const UploadPath& path) {
  return fmt::format("{}, {}", path.memory == Memory::kMapped ? "mapped buffer" : "client memory",
                     path.order == Order::kBgra ? "BGRA" : "RGBA");
}

}  // namespace

std::vector<UploadRate> measureUploads(devices::GlContext& context) {
  context.makeCurrent();
  UploadMemory memory;
  std::vector<UploadRate> rates;
  for (const auto& path : kPaths) rates.push_back({path, 4.0 * kExtent * kExtent / secondsOf(path, memory)});
  return rates;
}

UploadPath fastestUpload(std::span<const UploadRate> rates) {
  const auto best = std::ranges::max_element(rates, {}, &UploadRate::bytesPerSecond);
  if (best == rates.end() || best->bytesPerSecond < kClearlyFaster * rateOf(rates, kPlain)) return kPlain;
  return best->path;
}

std::string describeUploads(std::span<const UploadRate> rates) {
  const UploadPath taken = fastestUpload(rates);
  std::string others;
  for (const auto& [path, rate] : rates) {
    if (path == taken) continue;
    others += fmt::format("{}{} {:.1f}", others.empty() ? "" : "; ", nameOf(path), rate / 1e9);
  }
  return fmt::format("{} {:.1f} GB/s ({})", nameOf(taken), rateOf(rates, taken) / 1e9, others);
}

}  // namespace pixelflex::viewer
