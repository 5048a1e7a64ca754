// A projector pixel: the desktop at its place, as light, times the blend mask, as the device's code.
noperspective in vec3 texelAndWeight;
flat in int layer;
flat in ivec2 tileOrigin;
flat in ivec4 held;

layout(location = 0) out vec4 device;

#if MASK
uniform sampler2D mask;
#endif

void main() {
  vec2 texel = texelAndWeight.xy / texelAndWeight.z;
  vec3 code = filtered(texel, held, layer);
#if MEASURE
  device = vec4(code, 1.0);
#else
  code = withCursor(clamp(code, 0.0, 1.0), texel + vec2(tileOrigin));
  vec3 light = lightFromDesktop(code);
#if MASK
  light *= texelFetch(mask, ivec2(gl_FragCoord.xy), 0).r;
#endif
  vec3 value = clamp(deviceFromLight(light), 0.0, 1.0);
#if DITHER
  value = dithered(value, uvec2(gl_FragCoord.xy));
#endif
  device = vec4(value, 1.0);
#endif
}
