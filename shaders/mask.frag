// The blend mask, multiplied into what is there.
uniform sampler2D mask;

layout(location = 0) out vec4 factor;

void main() { factor = vec4(vec3(texelFetch(mask, ivec2(gl_FragCoord.xy), 0).r), 1.0); }
