// Both eyes' pictures as one, for an ordinary screen.
uniform sampler2D leftEye;
uniform sampler2D rightEye;
uniform bool sideBySide;  // else red for the left eye, green and blue for the right

layout(location = 0) out vec4 code;

vec3 squeezed(sampler2D picture, ivec2 narrow) {
  ivec2 pixel = ivec2(2 * narrow.x, narrow.y);
  return 0.5 * (texelFetch(picture, pixel, 0).rgb + texelFetch(picture, pixel + ivec2(1, 0), 0).rgb);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int middle = textureSize(leftEye, 0).x / 2;
  if (!sideBySide) {
    code = vec4(texelFetch(leftEye, pixel, 0).r, texelFetch(rightEye, pixel, 0).gb, 1.0);
  } else if (pixel.x < middle) {
    code = vec4(squeezed(leftEye, pixel), 1.0);
  } else {
    code = vec4(squeezed(rightEye, pixel - ivec2(middle, 0)), 1.0);
  }
}
