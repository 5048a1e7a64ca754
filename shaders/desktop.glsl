// Reading the desktop. A tile's texels are fetched, not filtered by the sampler: a sampler's weights may have eight bits.
uniform sampler2DArray desktop;

vec3 heldTexel(ivec2 texel, ivec4 held, int layer) {
  vec3 value = texelFetch(desktop, ivec3(clamp(texel, held.xy, held.zw), layer), 0).rgb;
#if FILTER_LIGHT
  return lightFromSrgb(value);
#else
  return value;
#endif
}

#if FILTER == 0
// Keys' cubic with a = -1/2: passes through the samples and reproduces straight lines.
vec4 cubicWeights(float t) {
  return vec4(t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2.0 - 1.5 * t)),
              t * t * (-0.5 + 0.5 * t));
}

vec3 cubicRow(ivec2 first, vec4 weights, ivec4 held, int layer, vec3 base) {
  return weights.x * (heldTexel(first, held, layer) - base) +
         weights.y * (heldTexel(first + ivec2(1, 0), held, layer) - base) +
         weights.z * (heldTexel(first + ivec2(2, 0), held, layer) - base) +
         weights.w * (heldTexel(first + ivec2(3, 0), held, layer) - base);
}

vec3 filtered(vec2 position, ivec4 held, int layer) {
  vec2 middle = floor(position - 0.5);
  vec2 t = position - 0.5 - middle;
  vec4 across = cubicWeights(t.x);
  vec4 down = cubicWeights(t.y);
  ivec2 first = ivec2(middle) - 1;
#if MEASURE
  // Numbers far from zero: differences are summed, so that rounding stays small beside them.
  vec3 base = heldTexel(ivec2(middle), held, layer);
#else
  const vec3 base = vec3(0.0);
#endif
  return base + down.x * cubicRow(first, across, held, layer, base) +
         down.y * cubicRow(first + ivec2(0, 1), across, held, layer, base) +
         down.z * cubicRow(first + ivec2(0, 2), across, held, layer, base) +
         down.w * cubicRow(first + ivec2(0, 3), across, held, layer, base);
}
#elif FILTER == 1
vec3 filtered(vec2 position, ivec4 held, int layer) {
  vec2 low = floor(position - 0.5);
  vec2 t = position - 0.5 - low;
  ivec2 first = ivec2(low);
  vec3 upper = mix(heldTexel(first, held, layer), heldTexel(first + ivec2(1, 0), held, layer), t.x);
  vec3 lower = mix(heldTexel(first + ivec2(0, 1), held, layer), heldTexel(first + ivec2(1, 1), held, layer), t.x);
  return mix(upper, lower, t.y);
}
#else
vec3 filtered(vec2 position, ivec4 held, int layer) { return heldTexel(ivec2(floor(position)), held, layer); }
#endif
