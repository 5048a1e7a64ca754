// Between codes and light. Light is linear, 1 is the projector's white (IEC 61966-2-1 for sRGB).
// The power by a polynomial of least relative error, 5e-6, that is 1 at 1: a fraction of what pow costs, and far below
// what the dither's steps tell apart.
vec3 lightFromSrgb(vec3 code) {
  vec3 curve = vec3(0.28993593638570087);
  curve = curve * code - 1.3629553562127414;
  curve = curve * code + 2.7611209565718067;
  curve = curve * code - 3.204641459677246;
  curve = curve * code + 2.4368542559250805;
  curve = curve * code - 1.407574347782043;
  curve = curve * code + 0.9787674573188115;
  curve = curve * code + 0.471553150844099;
  curve = curve * code + 0.0361017164572599;
  curve = curve * code + 0.000837690169272487;
  return mix(curve, code * (1.0 / 12.92), lessThanEqual(code, vec3(0.04045)));
}

vec3 srgbFromLight(vec3 light) {
  vec3 curve = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, light * 12.92, lessThanEqual(light, vec3(0.0031308)));
}

#if RESPONSE
// Channel after channel, evenly spaced in light^(1/2). Lower half: device code, upper half: what it gains up to the next
// entry; 65535 is 1.
uniform usamplerBuffer inverseResponse;
uniform int responseEntries;  // of a channel

float codeFromLight(float place, int channel) {
  int low = int(place);
  uint code = texelFetch(inverseResponse, channel * responseEntries + low).r;
  return (float(code & 0xffffu) + (place - float(low)) * float(code >> 16)) * (1.0 / 65535.0);
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
  vec3 place = sqrt(light) * float(responseEntries - 1);
  return vec3(codeFromLight(place.r, 0), codeFromLight(place.g, 1), codeFromLight(place.b, 2));
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
uniform sampler2D noise;  // a square tile; all codes of eight bits equally often
uniform int noiseMask;    // its extent, a power of two, minus one

// Rounds a device value to a code, up or down by chance, so that the mean over a few pixels is the value itself. The
// chance is blue noise, the same everywhere and in every frame. It lies in steps of 1/256 at (k + 1/2)/256, so a value
// that is a code already, 0 and 1 among them, stays.
vec3 dithered(vec3 device, ivec2 pixel) {
  vec3 chance = texelFetch(noise, pixel & noiseMask, 0).rgb * (255.0 / 256.0) + 0.5 / 256.0;
  return floor(device * highestCode + chance) * (1.0 / highestCode);
}
#endif
