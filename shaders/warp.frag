// A projector pixel: the desktop at its place, as light, matched to the other projectors and blended with them, as the
// device's code.
noperspective in vec3 texelAndWeight;
flat in int layer;
flat in ivec2 tileOrigin;
flat in ivec4 held;

layout(location = 0) out vec4 device;

uniform float brightness;  // of the desktop's light, 1: as it is
#if COLOUR
uniform mat3 colour;
#endif
#if MASK || BLACK
uniform usampler2D lightMap;  // lower half: root of blend and gain, upper half: black; 65535 is 1
uniform vec3 largestBlack;    // light, over 65535
#endif

vec3 lightAt(vec2 texel) {
  vec3 value = clamp(filtered(texel, held, layer), 0.0, 1.0);
#if !FILTER_LIGHT
  return lightFromDesktop(withCursor(value, texel + vec2(tileOrigin)));
#elif CURSOR
  return lightFromSrgb(withCursor(srgbFromLight(value), texel + vec2(tileOrigin)));
#else
  return value;
#endif
}

// Held to what the device can show only at the end: below the black level there is room for a negative component.
vec3 matched(vec3 light) {
#if COLOUR
  light = colour * light;
#endif
#if MASK || BLACK
  uint both = texelFetch(lightMap, ivec2(gl_FragCoord.xy), 0).r;
#endif
#if MASK
  float root = float(both & 0xffffu) * (1.0 / 65535.0);
  light *= root * root;
#endif
#if BLACK
  light += largestBlack * float(both >> 16);
#endif
#if COLOUR || BLACK
  light = clamp(light, 0.0, 1.0);
#endif
  return light;
}

void main() {
  vec2 texel = texelAndWeight.xy / texelAndWeight.z;
#if MEASURE
  device = vec4(filtered(texel, held, layer), 1.0);
#else
  vec3 value = clamp(deviceFromLight(matched(brightness * lightAt(texel))), 0.0, 1.0);
#if DITHER
  value = dithered(value, ivec2(gl_FragCoord.xy));
#elif TEN_BITS
  value = rounded(value);
#endif
  device = vec4(value, 1.0);
#endif
}
