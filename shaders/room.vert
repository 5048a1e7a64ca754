// A corner of a projector's picture on the wall, seen straight on.
layout(location = 0) in vec2 pixelInProjector;
layout(location = 1) in vec2 pointInWall;
layout(location = 2) in float radianceAtWhite;

uniform vec4 frameFromWall;  // scale x, scale y, shift x, shift y: wall units to frame pixels
uniform vec2 frameSize;

noperspective out vec2 pixel;
noperspective out float radiance;

void main() {
  vec2 inFrame = pointInWall * frameFromWall.xy + frameFromWall.zw;
  gl_Position = vec4(2.0 * inFrame / frameSize - 1.0, 0.0, 1.0);
  pixel = pixelInProjector;
  radiance = radianceAtWhite;
}
