#include "viewer/renderer/output_light.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/stretched_gain.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

constexpr std::uint32_t kOne = 65535;
constexpr int kResponseEntries = 8192;

void checkMap(const OutputPlan& plan, const devices::Image16& map, std::string_view what) {
  if (map.empty() || (map.size() == plan.resolution && map.channels() == 1)) return;
  throw RendererError(fmt::format("the {} of '{}' is {}x{} with {} channels, the output {}x{}", what, plan.name,
                                  map.width(), map.height(), map.channels(), plan.resolution.width,
                                  plan.resolution.height));
}

void checkGain(const OutputPlan& plan) {
  if (plan.gain.empty() || plan.gain.channels() == 1) return;
  throw RendererError(fmt::format("the gain of '{}' has {} channels instead of one", plan.name, plan.gain.channels()));
}

void checkNumbers(const OutputPlan& plan) {
  bool sound = true;
  for (int column = 0; column < 3; ++column) {
    sound = sound && std::isfinite(plan.largestBlack[column]);
    for (int row = 0; row < 3; ++row) sound = sound && std::isfinite(plan.colour[column][row]);
  }
  if (!sound) throw RendererError(fmt::format("the colour matrix or black level of '{}' is not finite", plan.name));
}

bool hasResponse(const OutputPlan& plan) {
  const auto absent = std::count_if(plan.inverseResponse.begin(), plan.inverseResponse.end(),
                                    [](const auto& channel) { return channel.empty(); });
  const bool tooShort = std::any_of(plan.inverseResponse.begin(), plan.inverseResponse.end(),
                                    [](const auto& channel) { return channel.size() == 1; });
  if (absent % 3 != 0 || tooShort) {
    throw RendererError(
        fmt::format("the inverse response of '{}' needs two or more entries for each of red, green and "
                    "blue",
                    plan.name));
  }
  return absent == 0;
}

/// The code for a light, from entries that are evenly spaced in light^(1/2.2).
double codeFor(double light, const std::vector<float>& entries) {
  const double place = std::pow(light, 1 / 2.2) * static_cast<double>(entries.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), entries.size() - 2);
  const double part = place - static_cast<double>(low);
  return (1 - part) * entries[low] + part * entries[low + 1];
}

/// As the shader wants them, to which a square root costs next to nothing: evenly spaced in light^(1/2), code and step
/// to the next in one number, to be fetched at once.
void addBySquareRoot(const std::vector<float>& entries, std::vector<std::uint32_t>& result) {
  const auto codeAt = [&entries](int i) {
    const double root = static_cast<double>(std::min(i, kResponseEntries - 1)) / (kResponseEntries - 1);
    return static_cast<std::uint32_t>(std::lround(kOne * std::clamp(codeFor(root * root, entries), 0.0, 1.0)));
  };
  for (int i = 0; i < kResponseEntries; ++i) {
    const std::uint32_t code = codeAt(i);
    const std::uint32_t next = std::max(code, codeAt(i + 1));
    result.push_back(code | (next - code) << 16U);
  }
}

}  // namespace

OutputLight::OutputLight(const OutputPlan& plan) : colour_(plan.colour), largestBlack_(plan.largestBlack) {
  checkMap(plan, plan.alpha, "alpha mask");
  checkMap(plan, plan.black, "black map");
  checkGain(plan);
  checkNumbers(plan);
  masked_ = !plan.alpha.empty() || !plan.gain.empty();
  lifted_ = !plan.black.empty();
  if (masked_ || lifted_) makeMap(plan);
  if (hasResponse(plan)) makeResponse(plan);
}

void OutputLight::addTo(WarpVariant& variant) const {
  variant.colour = colour_ != glm::mat3(1);
  variant.mask = masked_;
  variant.black = lifted_;
  variant.response = static_cast<bool>(response_);
}

void OutputLight::makeMap(const OutputPlan& plan) {
  std::vector<std::uint32_t> map(static_cast<std::size_t>(plan.resolution.area()), kOne);
  // Roots: of what is next to nothing, sixteen bits tell too little.
  const auto root = [](float part) { return static_cast<std::uint32_t>(std::lround(kOne * std::sqrt(part))); };
  if (!plan.gain.empty()) {
    const auto product = stretchedGain(plan.gain, plan.alpha, plan.resolution);
    std::ranges::transform(product.samples(), map.begin(), root);
  } else if (!plan.alpha.empty()) {
    std::ranges::transform(plan.alpha.samples(), map.begin(),
                           [&root](std::uint16_t part) { return root(static_cast<float>(part) / kOne); });
  }
  for (std::size_t i = 0; lifted_ && i < map.size(); ++i) map[i] |= std::uint32_t{plan.black.samples()[i]} << 16U;
  map_ = makeTexture(GL_R32UI, plan.resolution);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(map_.get(), 0, 0, 0, plan.resolution.width, plan.resolution.height, GL_RED_INTEGER,
                      GL_UNSIGNED_INT, map.data());
}

void OutputLight::makeResponse(const OutputPlan& plan) {
  std::vector<std::uint32_t> entries;
  for (const auto& channel : plan.inverseResponse) addBySquareRoot(channel, entries);
  const auto bytes = std::as_bytes(std::span(entries));
  responseEntries_ = devices::GlBuffer::create();
  glNamedBufferStorage(responseEntries_.get(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  response_ = devices::GlTexture::create(GL_TEXTURE_BUFFER);
  glTextureBuffer(response_.get(), GL_R32UI, responseEntries_.get());
}

void OutputLight::bind() const {
  glBindTextureUnit(kLightMapUnit, map_.get());
  glBindTextureUnit(kResponseUnit, response_.get());
}

void OutputLight::setUniforms(const devices::GlProgram& program) const {
  program.set("lightMap", static_cast<int>(kLightMapUnit));
  program.set("inverseResponse", static_cast<int>(kResponseUnit));
  program.set("colour", colour_);
  program.set("largestBlack", largestBlack_ / 65535.0F);
  program.set("responseEntries", kResponseEntries);
}

}  // namespace pixelflex::viewer
