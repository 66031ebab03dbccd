// References: Guennebaud, Barthe, Paulin 2006, section 6; lib/peel_state.glsl, which reads the result.
// Summary: the depth to which each sample is peeled after a layer, and how much the nearer layers hide. Hooks: `start`,
//          `peel` for further values of the surface that provides depth and normal.

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
