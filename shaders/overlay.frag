// Text and borders that lie over a projector's finished frame.
uniform sampler2D image;
uniform ivec2 imageAt;  // the frame's pixel of its top-left one
uniform vec4 colour;
uniform bool plain;  // the colour instead of the image

layout(location = 0) out vec4 device;

void main() {
  device = plain ? colour : texelFetch(image, ivec2(gl_FragCoord.xy) - imageAt, 0);
}
