// The light that one projector throws on a point of the wall.
noperspective in vec2 pixel;
noperspective in float radiance;

layout(location = 0) out vec4 light;

uniform sampler2D frameLight;  // linear filter

void main() {
  // Four places inside the picture's pixel: the window is mostly coarser than the projectors.
  vec2 across = 0.25 * dFdx(pixel);
  vec2 down = 0.25 * dFdy(pixel);
  vec2 scale = 1.0 / vec2(textureSize(frameLight, 0));
  vec3 sum = texture(frameLight, scale * (pixel - across - down)).rgb +
             texture(frameLight, scale * (pixel + across - down)).rgb +
             texture(frameLight, scale * (pixel - across + down)).rgb +
             texture(frameLight, scale * (pixel + across + down)).rgb;
  light = vec4(0.25 * radiance * sum, 1.0);
}
