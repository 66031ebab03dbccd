// References: Guennebaud, Barthe, Paulin 2006, section 6.
// Summary: composites the transparent layers of a pixel over the opaque picture: premultiplied colour, normal and
//          coverage, nearest depth; the transmitted share is given. Hooks: `before` for the normal, `hand` for further
//          outputs.

#include "hosts/outputs.glsl"

#parts
void put_layers_before(inout vec4 color, inout vec4 normal, inout float nearest, inout Outputs outputs) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 before = texelFetch(layers, pixel, 0);
  float depth_before = texelFetch(layers_depth, pixel, 0).r;
  color += before;
  normal.w += before.w;
  #hook before(pixel, normal)
  #hook hand(pixel, outputs)
  if (depth_before > 0.0) nearest = min(nearest, depth_before);
}
