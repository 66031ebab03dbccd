// References: Guennebaud, Barthe, Paulin 2006, section 6; lib/peel_state.glsl, which reads the result.
// Summary: how deep each sample is peeled after a layer, and what lies before that hides. Hooks: `start`, `peel` what else
//          is known of the surface that depth and normal are of.

#include "lib/layer_at.glsl"

#parts
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float before = texelFetch(peel_state, at, 0).y, depth = texelFetch(layer_depth, at, 0).r;
  peel_state_next = vec2(1.0, before);
  #hook start(at)
  if (depth < 1.0) {
    float opacity = layer_at(at).w;
    float hidden = 1.0 - (1.0 - abs(before)) * (1.0 - opacity);
    bool is_surface = before < 0.0 || (opacity >= frame.alpha_threshold && hidden > 0.0);
    peel_state_next = vec2(depth, is_surface ? -hidden : hidden);
    #hook peel(at, is_surface, before)
  }
}
