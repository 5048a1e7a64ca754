// A corner of a projector's warp mesh: placed at its projector pixel, carrying its place in one desktop tile.
layout(location = 0) in vec2 pixelInProjector;
layout(location = 1) in vec3 weightedTexel;  // texel position in the tile times w, and w
layout(location = 2) in int tile;

uniform vec2 resolution;    // of the projector
uniform ivec2 desktopSize;
uniform ivec3 tiling;       // tiles in a row, stride, apron

noperspective out vec3 texelAndWeight;
flat out int layer;
flat out ivec2 tileOrigin;  // desktop position of the tile's texel corner (0, 0)
flat out ivec4 held;        // first and last texel of the tile that hold a desktop pixel

void main() {
  // Row 0 of the frame is the top of the picture, so y is not turned over.
  gl_Position = vec4(2.0 * pixelInProjector / resolution - 1.0, 0.0, 1.0);
  texelAndWeight = weightedTexel;
  layer = tile;
  tileOrigin = ivec2(tile % tiling.x, tile / tiling.x) * tiling.y - tiling.z;
  int extent = tiling.y + 2 * tiling.z;
  held = ivec4(max(-tileOrigin, ivec2(0)), min(desktopSize - tileOrigin, ivec2(extent)) - 1);
}
