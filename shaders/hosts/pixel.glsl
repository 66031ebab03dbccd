// References: hosts/before_layers.glsl, hosts/outputs.glsl.
// Summary: writes a pixel of the opaque picture from the means over its samples. Hooks: `before` composites what is in
//          front of it, `pixel` writes further outputs.

#include "hosts/outputs.glsl"

const float EMPTY_DEPTH = 1e10;
#include "lib/farthest.glsl"

#parts
// normal: in view space, and coverage. nearest: FARTHEST if nothing was hit.
void write_pixel(vec4 color, vec4 normal, float nearest, Outputs outputs) {
  normal.xyz = mat3(view.to_world) * normal.xyz;
  #hook before(color, normal, nearest, outputs)
  combined = color;
  #hook pixel(normal)
  write_outputs(before_background(outputs, normal.w));
  depth = nearest < FARTHEST ? nearest : EMPTY_DEPTH;
}
