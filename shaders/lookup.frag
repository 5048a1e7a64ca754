// The last look-up: from a scene's blended light to the codes of the device.
uniform sampler2D scene;
#if COLOUR
uniform mat3 colour;
#endif
#if BLACK
uniform usampler2D lightMap;  // upper half: black; 65535 is 1
uniform vec3 largestBlack;    // light, over 65535
#endif

layout(location = 0) out vec4 device;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 light = texelFetch(scene, pixel, 0).rgb;
#if COLOUR
  light = colour * light;  // a mask that is a factor of all three colours may come before
#endif
#if BLACK
  light += largestBlack * float(texelFetch(lightMap, pixel, 0).r >> 16);
#endif
  vec3 value = clamp(deviceFromLight(clamp(light, 0.0, 1.0)), 0.0, 1.0);
#if DITHER
  value = dithered(value, pixel);
#endif
  device = vec4(value, 1.0);
}
