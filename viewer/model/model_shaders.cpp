#include "viewer/model/model_shaders.h"

#include <fmt/format.h>

#include "shader_sources.h"

namespace pixelflex::viewer {
namespace {

std::string definitionsOf(const ModelVariant& v) {
  // Of the light's functions only sRGB's decoding is used.
  return fmt::format(
      "#define LENS {:d}\n#define CLIP {:d}\n#define CUT {:d}\n#define MEASURE {:d}\n#define LIT {:d}\n"
      "#define SHINY {:d}\n#define PICTURE {:d}\n#define CUTOFF {:d}\n#define BLEND {:d}\n"
      "#define RESPONSE 0\n#define DITHER 0\n#define LINEAR_DESKTOP 0\n#define TEN_BITS 0\n",
      v.lens, v.clip, v.cut, v.measure, v.lit, v.shiny, v.picture, v.cutoff, v.blend);
}

std::string definitionsOf(const WarpVariant& v) {
  return fmt::format(
      "#define COLOUR {:d}\n#define MASK {:d}\n#define BLACK {:d}\n#define RESPONSE {:d}\n#define DITHER {:d}\n"
      "#define LINEAR_DESKTOP {:d}\n#define TEN_BITS 0\n",
      v.colour, v.mask, v.black, v.response, v.dither, v.transfer == DesktopTransfer::kLinear);
}

}  // namespace

const devices::GlProgram& ModelShaders::model(const ModelVariant& variant) {
  const auto found = models_.find(variant);
  if (found != models_.end()) return found->second;
  const std::string definitions = definitionsOf(variant);
  return models_
      .emplace(variant, devices::GlProgram("model", {definitions, shaders::kModelVert},
                                           {definitions, shaders::kLightGlsl, shaders::kModelFrag}))
      .first->second;
}

const devices::GlProgram& ModelShaders::lookUp(const WarpVariant& variant) {
  const auto found = lookUps_.find(variant);
  if (found != lookUps_.end()) return found->second;
  const std::string definitions = definitionsOf(variant);
  return lookUps_
      .emplace(variant, devices::GlProgram("lookup", {shaders::kNearVert},
                                           {definitions, shaders::kLightGlsl, shaders::kLookupFrag}))
      .first->second;
}

}  // namespace pixelflex::viewer
