#include "viewer/renderer/warp_programs.h"

#include <fmt/format.h>

#include "shader_sources.h"

namespace pixelflex::viewer {
namespace {

std::string definitionsOf(const WarpVariant& variant) {
  return fmt::format(
      "#define EXACT {:d}\n#define MEASURE {:d}\n#define MASK {:d}\n#define RESPONSE {:d}\n#define CURSOR {:d}\n"
      "#define DITHER {:d}\n#define LINEAR_DESKTOP {:d}\n#define FILTER {}\n",
      variant.exact, variant.measure, variant.mask, variant.response, variant.cursor, variant.dither,
      variant.transfer == DesktopTransfer::kLinear, static_cast<int>(variant.filter));
}

devices::GlProgram build(const WarpVariant& variant, const std::string& definitions) {
  if (variant.exact) {
    return {"exact", {shaders::kFullscreenVert}, {definitions, shaders::kCursorGlsl, shaders::kExactFrag}};
  }
  return {"warp",
          {shaders::kWarpVert},
          {definitions, shaders::kDesktopGlsl, shaders::kCursorGlsl, shaders::kLightGlsl, shaders::kWarpFrag}};
}

}  // namespace

const devices::GlProgram& WarpPrograms::get(const WarpVariant& variant) {
  const auto definitions = definitionsOf(variant);
  const auto found = programs_.find(definitions);
  if (found != programs_.end()) return found->second;
  return programs_.emplace(definitions, build(variant, definitions)).first->second;
}

}  // namespace pixelflex::viewer
