// A point of the model as light, with a lamp beside the audience. What of it a projector shows does not depend on the
// projector.
in vec3 inModel;
in vec3 inWindow;
in vec3 normalInWindow;
in vec2 picturePlace;
in vec3 code;

layout(location = 0) out vec4 light;

uniform vec3 eye;  // in the window's frame
uniform vec3 materialColour;
uniform bool lit;
uniform bool hasPicture;
uniform sampler2D picture;

float brightness() {
  vec3 toEye = normalize(eye - inWindow);
  vec3 normal = normalize(normalInWindow);
  if (dot(normal, toEye) < 0.0) normal = -normal;
  const vec3 lamp = normalize(vec3(0.4, 0.7, 1.0));
  return 0.08 + 0.72 * max(dot(normal, lamp), 0.0) + 0.2 * max(dot(normal, toEye), 0.0);
}

void main() {
#if MEASURE
  light = vec4(inModel, 1.0);
#else
  vec3 own = materialColour * lightFromSrgb(code);
  if (hasPicture) own *= texture(picture, picturePlace).rgb;
  if (lit) own *= brightness();
  light = vec4(own, 1.0);
#endif
}
