// References: as peel.frag.glsl.
// Summary: how much is hidden in front of each sample's opaque surface, including the last, unordered layer.

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float before = texelFetch(peel_state, texel, 0).y;
  float hidden = 1.0 - (1.0 - abs(before)) * (1.0 - texelFetch(shaded, texel, 0).w);
  peel_state_next = vec2(1.0, before < 0.0 ? -hidden : hidden);
}
