// The pointer's image, laid over the desktop's colour before anything else happens to it.
#if CURSOR
uniform sampler2D cursorImage;  // colours already times alpha
uniform ivec2 cursorAt;         // desktop pixel of the image's top-left corner

vec4 cursorTexel(ivec2 texel) {
  ivec2 size = textureSize(cursorImage, 0);
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
  return inside ? texelFetch(cursorImage, texel, 0) : vec4(0.0);
}

vec3 withCursorTexel(vec3 below, ivec2 desktopPixel) {
  vec4 cursor = cursorTexel(desktopPixel - cursorAt);
  return cursor.rgb + (1.0 - cursor.a) * below;
}

vec3 withCursor(vec3 below, vec2 desktopPosition) {
  vec2 position = desktopPosition - vec2(cursorAt) - 0.5;
  vec2 low = floor(position);
  vec2 t = position - low;
  ivec2 first = ivec2(low);
  vec4 upper = mix(cursorTexel(first), cursorTexel(first + ivec2(1, 0)), t.x);
  vec4 lower = mix(cursorTexel(first + ivec2(0, 1)), cursorTexel(first + ivec2(1, 1)), t.x);
  vec4 cursor = mix(upper, lower, t.y);
  return cursor.rgb + (1.0 - cursor.a) * below;
}
#else
vec3 withCursorTexel(vec3 below, ivec2 desktopPixel) { return below; }
vec3 withCursor(vec3 below, vec2 desktopPosition) { return below; }
#endif
