// A projector's frame as light: codes become light before neighbours are mixed.
uniform sampler2D frame;
uniform sampler2D response;  // 256 x 1: light of each code, per channel

layout(location = 0) out vec4 light;

// Between codes of eight bits, as a frame of more has them, the response is straight.
float lightOf(float value, int channel) {
  float place = value * 255.0;
  int low = min(int(place), 254);
  float below = texelFetch(response, ivec2(low, 0), 0)[channel];
  float above = texelFetch(response, ivec2(low + 1, 0), 0)[channel];
  return mix(below, above, place - float(low));
}

void main() {
  vec3 device = texelFetch(frame, ivec2(gl_FragCoord.xy), 0).rgb;
  light = vec4(lightOf(device.r, 0), lightOf(device.g, 1), lightOf(device.b, 2), 1.0);
}
