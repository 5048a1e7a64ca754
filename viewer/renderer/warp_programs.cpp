#include "viewer/renderer/warp_programs.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "shader_sources.h"
#include "viewer/renderer/dither_tile.h"
#include "viewer/renderer/textures.h"

namespace pixelflex::viewer {
namespace {

std::string definitionsOf(const WarpVariant& variant) {
  return fmt::format(
      "#define EXACT {:d}\n#define MEASURE {:d}\n#define COLOUR {:d}\n#define MASK {:d}\n#define BLACK {:d}\n"
      "#define RESPONSE {:d}\n#define CURSOR {:d}\n#define DITHER {:d}\n#define LINEAR_DESKTOP {:d}\n#define FILTER "
      "{}\n"
      "#define FILTER_LIGHT {:d}\n#define TEN_BITS {:d}\n",
      variant.exact, variant.measure, variant.colour, variant.mask, variant.black, variant.response, variant.cursor,
      variant.dither, variant.transfer == DesktopTransfer::kLinear, static_cast<int>(variant.filter),
      variant.filterLight, variant.tenBits);
}

devices::GlProgram build(const WarpVariant& variant, const std::string& definitions) {
  if (variant.exact) {
    return {"exact",
            {shaders::kFullscreenVert},
            {definitions, shaders::kLightGlsl, shaders::kCursorGlsl, shaders::kExactFrag}};
  }
  return {"warp",
          {shaders::kWarpVert},
          {definitions, shaders::kLightGlsl, shaders::kDesktopGlsl, shaders::kCursorGlsl, shaders::kWarpFrag}};
}

}  // namespace

const devices::GlProgram& WarpPrograms::get(const WarpVariant& variant) {
  const auto found = programs_.find(variant);
  if (found != programs_.end()) return found->second;
  return programs_.emplace(variant, build(variant, definitionsOf(variant))).first->second;
}

const devices::GlProgram& WarpPrograms::overlay() {
  if (!overlay_) {
    overlay_.emplace("overlay", devices::ShaderPieces{shaders::kFullscreenVert},
                     devices::ShaderPieces{shaders::kOverlayFrag});
  }
  return *overlay_;
}

devices::GlName WarpPrograms::ditherTile() {
  if (!ditherTile_) {
    static const devices::Image8 tile = makeDitherTile();
    ditherTile_ = makeTexture(GL_RGBA8, tile.size());  // four bytes are one to fetch
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(ditherTile_.get(), 0, 0, 0, tile.width(), tile.height(), GL_RGB, GL_UNSIGNED_BYTE,
                        tile.samples().data());
  }
  return ditherTile_.get();
}

}  // namespace pixelflex::viewer
