// References: Guennebaud, Barthe, Paulin 2006, section 6.
// Summary: composites a transparent layer under the nearer ones, with depth and normal of its surface where no nearer
//          layer is opaque enough to provide them; for methods that do not filter silhouettes.

#include "lib/layer_at.glsl"
#include "lib/peel_state.glsl"
#include "hosts/layer_pixel.glsl"

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES;
  vec4 color_total = vec4(0.0);
  vec3 normal_total = vec3(0.0);
  Outputs outputs_total = NO_OUTPUTS;
  float nearest = FARTHEST;
  bool is_seen_nearer = false;
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) {
      ivec2 texel = first + ivec2(x, y);
      bool is_first = is_first_surface(texel);
      is_seen_nearer = is_seen_nearer || !is_first;
      if (texelFetch(layer_depth, texel, 0).r == 1.0) continue;
      vec4 here = layer_at(texel), s = texelFetch(surface, texel, 0);
      color_total += here * let_through(texel);
      outputs_total = added(outputs_total, layer_outputs_at(texel), let_through(texel));
      if (s.w > 0.0 && here.w >= frame.alpha_threshold && is_first) {
        normal_total += s.xyz;
        nearest = min(nearest, s.w * view.world_length);
      }
    }
  }
  float share = 1.0 / float(SAMPLES * SAMPLES);
  write_layer(color_total, normal_total, nearest, is_seen_nearer, outputs_total, share);
}
