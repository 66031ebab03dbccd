// References: Monsi, Saeki, "Über den Lichtfaktor in den Pflanzengesellschaften", 1953 (leaves as a turbid medium).
// Summary: within crowns no more of the world's light is left than the leaves around a place let through, on the sides
//          that the normal points to. The texture is that of rendering/bounced/crowns.py.

#part shaded_sample
#include "lib/cells.glsl"

void crowns_prepare(inout Shaded s) {
  float weight;
  vec3 place = (frame.to_cells * vec4(eye_position(s.texel, s.mean.depth), 1.0)).xyz;
  vec4 here = cells_at(place, normalize(mat3(frame.to_cells) * s.normal), false, weight);
  if (weight > 0.0) leave_open(min(here.a, open_share), s.mean.color);
}
