// A projector's frame as light: codes become light before neighbours are mixed.
uniform sampler2D frame;
uniform sampler2D response;  // 256 x 1: light of each code, per channel

layout(location = 0) out vec4 light;

void main() {
  ivec3 codes = ivec3(texelFetch(frame, ivec2(gl_FragCoord.xy), 0).rgb * 255.0 + 0.5);
  light = vec4(texelFetch(response, ivec2(codes.r, 0), 0).r, texelFetch(response, ivec2(codes.g, 0), 0).g,
               texelFetch(response, ivec2(codes.b, 0), 0).b, 1.0);
}
