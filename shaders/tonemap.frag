// From the sum of all light to a picture for a screen.
uniform sampler2D wallLight;
uniform float exposure;

layout(location = 0) out vec4 code;

void main() {
  vec3 light = exposure * texelFetch(wallLight, ivec2(gl_FragCoord.xy), 0).rgb;
  code = vec4(srgbFromLight(clamp(light, 0.0, 1.0)), 1.0);
}
