// A point of the model as light, with a lamp beside the audience. What of it a projector shows does not depend on the
// projector.
in vec3 inModel;
in vec3 inWindow;
in vec3 normalInWindow;
in vec2 picturePlace;
in vec4 code;

layout(location = 0) out vec4 light;  // times its share of the pixel, which is the fourth

uniform vec3 eye;  // in the window's frame
uniform vec3 materialColour;
uniform vec3 emission;
uniform float opacity;
#if SHINY
uniform vec3 shine;  // what comes back where it is strongest
uniform float shininess;
#endif
#if PICTURE
uniform sampler2D picture;
#endif
#if CUTOFF
uniform float cutoff;
#endif

#if LIT
// `own` as it is seen, a share of it where the surface is not opaque; what shines does so however clear the body is.
vec3 lit(vec3 own, float share) {
  vec3 toEye = normalize(eye - inWindow);
  vec3 normal = normalize(normalInWindow);
  if (dot(normal, toEye) < 0.0) normal = -normal;
  const vec3 lamp = normalize(vec3(0.4, 0.7, 1.0));
  float fromLamp = max(dot(normal, lamp), 0.0);
  vec3 seen = share * own * (0.08 + 0.72 * fromLamp + 0.2 * max(dot(normal, toEye), 0.0));
#if SHINY
  float facing = max(dot(normal, normalize(lamp + toEye)), 0.0);
  seen += shine * fromLamp * pow(facing, shininess);
#endif
  return seen;
}
#endif

void main() {
  vec4 own = vec4(materialColour * lightFromSrgb(code.rgb), opacity * code.a);
#if PICTURE
  vec4 texel = texture(picture, picturePlace);
#if CUTOFF || BLEND
  texel.rgb /= max(texel.a, 1e-3);  // colours were weighted, so that those of holes do not show at their borders
#endif
  own *= texel;
#endif
#if CUTOFF
  if (own.a < cutoff) discard;
#endif
#if MEASURE
  light = vec4(inModel, 1.0);
#else
#if !BLEND
  own.a = 1.0;
#endif
#if LIT
  light = vec4(lit(own.rgb, own.a) + emission, own.a);
#else
  light = vec4(own.rgb * own.a + emission, own.a);
#endif
  light.rgb = min(light.rgb, vec3(1.0));  // white is the desktop's, before masks
#endif
}
