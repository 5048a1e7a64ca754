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
#if MASK
uniform sampler2D mask;  // of blend and gain
#endif
#if BLACK
uniform sampler2D black;
uniform vec3 largestBlack;  // light
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
#if MASK
  light *= texelFetch(mask, ivec2(gl_FragCoord.xy), 0).r;
#endif
#if BLACK
  light += largestBlack * texelFetch(black, ivec2(gl_FragCoord.xy), 0).r;
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
