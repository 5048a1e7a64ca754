// Between codes and light. Light is linear, 1 is the projector's white (IEC 61966-2-1 for sRGB).
vec3 lightFromSrgb(vec3 code) {
  vec3 curve = pow((code + 0.055) / 1.055, vec3(2.4));
  return mix(curve, code / 12.92, lessThanEqual(code, vec3(0.04045)));
}

vec3 srgbFromLight(vec3 light) {
  vec3 curve = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, light * 12.92, lessThanEqual(light, vec3(0.0031308)));
}

#if RESPONSE
uniform sampler2D inverseResponse;  // a row of device codes per channel, evenly spaced in light^(1/2.2)
uniform ivec3 responseEntries;      // per channel

float codeFromLight(float light, int channel) {
  float place = pow(light, 1.0 / 2.2) * float(responseEntries[channel] - 1);
  int low = min(int(place), responseEntries[channel] - 2);
  float below = texelFetch(inverseResponse, ivec2(low, channel), 0).r;
  float above = texelFetch(inverseResponse, ivec2(low + 1, channel), 0).r;
  return mix(below, above, place - float(low));
}
#endif

vec3 lightFromDesktop(vec3 code) {
#if LINEAR_DESKTOP
  return code;
#else
  return lightFromSrgb(code);
#endif
}

vec3 deviceFromLight(vec3 light) {
#if RESPONSE
  return vec3(codeFromLight(light.r, 0), codeFromLight(light.g, 1), codeFromLight(light.b, 2));
#elif LINEAR_DESKTOP
  return light;
#else
  return srgbFromLight(light);
#endif
}

#if DITHER || TEN_BITS
uniform float highestCode;  // of the frame: 255 or 1023

// Ten bits are rounded here: a driver may cut off what it ought to round, but no driver changes a whole code.
vec3 rounded(vec3 device) { return floor(device * highestCode + 0.5) / highestCode; }
#endif

#if DITHER
uniform sampler2D noise;  // a square tile, its extent a power of two; all codes of eight bits equally often

// Rounds a device value to a code, up or down by chance, so that the mean over a few pixels is the value itself. The
// chance is blue noise, the same everywhere and in every frame. It lies in steps of 1/256 at (k + 1/2)/256, so a value
// that is a code already, 0 and 1 among them, stays.
vec3 dithered(vec3 device, ivec2 pixel) {
  vec3 chance = (texelFetch(noise, pixel & (textureSize(noise, 0) - 1), 0).rgb * 255.0 + 0.5) / 256.0;
  return floor(device * highestCode + chance) / highestCode;
}
#endif
