// References: Guennebaud, Barthe, Paulin 2006, section 6; common/peeled.glsl, which reads the result.
// Summary: how deep each sample is peeled after a layer, and what lies before that hides.

// IDENTITY: and whose the surface is that depth and normal are of.

#include "common/layer_at.glsl"

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float before = texelFetch(peeled, at, 0).y, depth = texelFetch(layer_depth, at, 0).r;
  peeled_next = vec2(1.0, before);
#ifdef IDENTITY
  identity_next = texelFetch(identity, at, 0).xy;
#endif
  if (depth < 1.0) {
    float opacity = layer_at(at).w;
    float hidden = 1.0 - (1.0 - abs(before)) * (1.0 - opacity);
    bool is_surface = before < 0.0 || (opacity >= shading.edges.y && hidden > 0.0);
    peeled_next = vec2(depth, is_surface ? -hidden : hidden);
#ifdef IDENTITY
    if (is_surface && before >= 0.0) identity_next = texelFetch(layer_identity, at, 0).xy;
#endif
  }
}
