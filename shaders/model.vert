// A corner of the model: by the matrix stack to the desktop's clip coordinates, and on to the projector's.
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec2 place;
layout(location = 3) in vec4 colour;

uniform mat4 desktopFromModel;
uniform mat4 projectorFromDesktop;
uniform mat4 windowFromModel;
uniform vec4 cut;  // the model is shown where the product with its position is positive
#if LENS
uniform sampler2D lens;    // shifts on a lattice over the frame and its surroundings
uniform float lensReach;   // of the lattice, in clip coordinates

vec2 bend(vec2 clip) {
  vec2 last = vec2(textureSize(lens, 0) - 1);
  vec2 at = clamp((clip / lensReach * 0.5 + 0.5) * last, vec2(0.0), last);
  ivec2 low = min(ivec2(at), ivec2(last) - 1);
  vec2 t = at - vec2(low);
  vec2 upper = mix(texelFetch(lens, low, 0).rg, texelFetch(lens, low + ivec2(1, 0), 0).rg, t.x);
  vec2 lower = mix(texelFetch(lens, low + ivec2(0, 1), 0).rg, texelFetch(lens, low + ivec2(1, 1), 0).rg, t.x);
  return mix(upper, lower, t.y);
}
#endif

out vec3 inModel;
out vec3 inWindow;
out vec3 normalInWindow;
out vec2 picturePlace;
out vec4 code;

void main() {
  vec4 onDesktop = desktopFromModel * vec4(position, 1.0);
  gl_Position = projectorFromDesktop * onDesktop;
#if LENS
  if (gl_Position.w > 0.0) gl_Position.xy += gl_Position.w * bend(gl_Position.xy / gl_Position.w);
#endif
#if CLIP
  // The display's own borders and depths, which are not the projector's.
  gl_ClipDistance[0] = onDesktop.w + onDesktop.x;
  gl_ClipDistance[1] = onDesktop.w - onDesktop.x;
  gl_ClipDistance[2] = onDesktop.w + onDesktop.y;
  gl_ClipDistance[3] = onDesktop.w - onDesktop.y;
  gl_ClipDistance[4] = onDesktop.w + onDesktop.z;
  gl_ClipDistance[5] = onDesktop.w - onDesktop.z;
#endif
#if CUT
  gl_ClipDistance[6] = dot(cut, vec4(position, 1.0));
#endif
  inModel = position;
  inWindow = (windowFromModel * vec4(position, 1.0)).xyz;
  normalInWindow = mat3(windowFromModel) * normal.xyz;
  picturePlace = place;
  code = colour;
}
