// References: Haeberli & Akeley 1990, "The accumulation buffer".
// Summary: adds a sample's pixels, without the margin of its tile, to the previous ones, and counts those with numbers
//          that cannot be added. Hook: `add` one pixel texture.

#include "lib/addable.glsl"

// What is added: black in place of what cannot be.
vec4 addable(vec4 texel, float black_alpha, inout bool is_odd) {
  if (is_addable(texel)) return texel;
  is_odd = true;
  return vec4(vec3(0.0), black_alpha);
}

#parts
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - ivec2(frame.corner.xy);
  bool is_odd = false;
  #hook add(texel, is_odd)
  odd_sum = is_odd ? 1.0 : 0.0;
}
