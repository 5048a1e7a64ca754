// The blend mask, multiplied into what is there.
uniform usampler2D lightMap;  // lower half: root of blend and gain; 65535 is 1

layout(location = 0) out vec4 factor;

void main() {
  float root = float(texelFetch(lightMap, ivec2(gl_FragCoord.xy), 0).r & 0xffffu) * (1.0 / 65535.0);
  factor = vec4(vec3(root * root), 1.0);
}
