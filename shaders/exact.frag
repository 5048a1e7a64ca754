// A screen that shows desktop pixels one to one: no filter, no arithmetic on colours but for a frame of
// other codes than the desktop's.
uniform sampler2DArray desktop;
uniform ivec3 tiling;   // tiles in a row, stride, apron
uniform ivec2 exactAt;  // the desktop pixel shown by the screen's top-left pixel
uniform ivec2 exactFrom;  // the part of the desktop that is shown, half-open
uniform ivec2 exactTo;
uniform float brightness;  // 1: as it is

layout(location = 0) out vec4 device;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy) + exactAt;
  if (any(lessThan(pixel, exactFrom)) || any(greaterThanEqual(pixel, exactTo))) {
    device = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
  ivec2 tile = ivec2((vec2(pixel) + 0.5) / float(tiling.y));
  ivec3 texel = ivec3(pixel - tile * tiling.y + tiling.z, tile.y * tiling.x + tile.x);
  vec3 code = withCursorTexel(texelFetch(desktop, texel, 0).rgb, pixel) * brightness;
#if TEN_BITS
  code = rounded(code);
#endif
  device = vec4(code, 1.0);
}
