// References: Guennebaud, Barthe, Paulin 2006, section 6.
// Summary: writes a transparent layer's contribution to a pixel from sums over its samples. Hook: `pixel` writes
//          further outputs.

#include "hosts/outputs.glsl"

#include "lib/farthest.glsl"

#parts
void write_layer(vec4 color, vec3 normal, float nearest, bool is_seen_nearer, Outputs outputs, float share) {
  layers = color * share;
  layers_depth = nearest < FARTHEST && !is_seen_nearer ? nearest : 0.0;
  normal = mat3(view.to_world) * normal * share;
  #hook pixel(normal)
  write_outputs(added(NO_OUTPUTS, outputs, share));
}
