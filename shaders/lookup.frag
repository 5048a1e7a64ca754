// Over the whole frame at the near plane, after the scene: the blend mask, and the last look-up, from light to the codes
// of the device.
uniform sampler2D scene;
#if COLOUR
uniform mat3 colour;
#endif
#if MASK || BLACK
uniform usampler2D lightMap;  // lower half: root of blend and gain, upper half: black; 65535 is 1
uniform vec3 largestBlack;    // light, over 65535
#endif

layout(location = 0) out vec4 device;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 light = texelFetch(scene, pixel, 0).rgb;
#if COLOUR
  light = colour * light;
#endif
#if MASK || BLACK
  uint both = texelFetch(lightMap, pixel, 0).r;
#endif
#if MASK
  float root = float(both & 0xffffu) * (1.0 / 65535.0);
  light *= root * root;
#endif
#if BLACK
  light += largestBlack * float(both >> 16);
#endif
  vec3 value = clamp(deviceFromLight(clamp(light, 0.0, 1.0)), 0.0, 1.0);
#if DITHER
  value = dithered(value, pixel);
#endif
  device = vec4(value, 1.0);
}
