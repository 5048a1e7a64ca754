#include "viewer/renderer/output_light.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "viewer/renderer/renderer_error.h"
#include "viewer/renderer/stretched_gain.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

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

}  // namespace

OutputLight::OutputLight(const OutputPlan& plan) : colour_(plan.colour), largestBlack_(plan.largestBlack) {
  checkMap(plan, plan.alpha, "alpha mask");
  checkMap(plan, plan.black, "black map");
  checkGain(plan);
  checkNumbers(plan);
  if (!plan.alpha.empty() || !plan.gain.empty()) makeMask(plan);
  if (!plan.black.empty()) makeBlack(plan);
  if (hasResponse(plan)) makeResponse(plan);
}

void OutputLight::addTo(WarpVariant& variant) const {
  variant.colour = colour_ != glm::mat3(1);
  variant.mask = static_cast<bool>(mask_);
  variant.black = static_cast<bool>(black_);
  variant.response = static_cast<bool>(response_);
}

void OutputLight::makeMask(const OutputPlan& plan) {
  const auto [width, height] = plan.resolution;
  if (!plan.gain.empty()) {
    const auto product = stretchedGain(plan.gain, plan.alpha, plan.resolution);
    mask_ = makeTexture(GL_R32F, plan.resolution);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(mask_.get(), 0, 0, 0, width, height, GL_RED, GL_FLOAT, product.samples().data());
    return;
  }
  mask_ = makeTexture(GL_R16, plan.resolution);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(mask_.get(), 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_SHORT, plan.alpha.samples().data());
}

void OutputLight::makeBlack(const OutputPlan& plan) {
  black_ = makeTexture(GL_R16, plan.resolution);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(black_.get(), 0, 0, 0, plan.resolution.width, plan.resolution.height, GL_RED, GL_UNSIGNED_SHORT,
                      plan.black.samples().data());
}

void OutputLight::makeResponse(const OutputPlan& plan) {
  for (int channel = 0; channel < 3; ++channel) {
    responseEntries_[channel] = static_cast<int>(plan.inverseResponse[static_cast<std::size_t>(channel)].size());
  }
  const auto longest = std::max({responseEntries_.x, responseEntries_.y, responseEntries_.z});
  response_ = makeTexture(GL_R32F, {longest, 3});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (int channel = 0; channel < 3; ++channel) {
    glTextureSubImage2D(response_.get(), 0, 0, channel, responseEntries_[channel], 1, GL_RED, GL_FLOAT,
                        plan.inverseResponse[static_cast<std::size_t>(channel)].data());
  }
}

void OutputLight::bind() const {
  glBindTextureUnit(kMaskUnit, mask_.get());
  glBindTextureUnit(kBlackUnit, black_.get());
  glBindTextureUnit(kResponseUnit, response_.get());
}

void OutputLight::setUniforms(const devices::GlProgram& program) const {
  program.set("mask", static_cast<int>(kMaskUnit));
  program.set("black", static_cast<int>(kBlackUnit));
  program.set("inverseResponse", static_cast<int>(kResponseUnit));
  program.set("colour", colour_);
  program.set("largestBlack", largestBlack_);
  program.set("responseEntries", responseEntries_);
}

}  // namespace pixelflex::viewer
