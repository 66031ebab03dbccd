// References: none needed.
// Summary: the position in view space of what a sample sees at a depth.

vec3 eye_position(ivec2 texel, float depth) {
  vec2 place = view.window.xy + (vec2(texel) + 0.5) * view.window.zw;
  return vec3(view.is_parallel > 0.5 ? place : place * depth, -depth);
}
