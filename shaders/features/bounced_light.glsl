// References: Christensen, "Point-Based Approximate Color Bleeding", 2008 (merged surfels receive light); McTaggart,
//             "Half-Life 2 / Valve Source Shading", 2004 (light on six sides, by the squares of a normal's components).
// Summary: the light that surfaces and the world send to a surface: that of merged surfels in the cells around it, on the
//          sides that its normal points to. The texture is that of rendering/bounced/table.py. The twin of
//          reference/bounced_light.py.

#part world_light
vec4 bounced_here = vec4(0.0, 0.0, 0.0, 1.0);  // irradiance over pi, and the world's share
vec3 bounced_world = vec3(0.0);  // what the world alone would send if nothing were in its way, over pi
bool is_bounced = false;

void bounced_light_diffuse(inout vec3 light) {
  if (is_bounced) light = bounced_here.rgb;
}

void bounced_light_reflected(inout vec3 light, vec3 direction, float roughness) {
  if (is_bounced) light = bounced_here.a * light + max(bounced_here.rgb - bounced_here.a * bounced_world, vec3(0.0));
}

#part world_light, through
vec3 bounced_behind = vec3(0.0);  // irradiance over pi of the other side

void bounced_light_behind(inout vec3 light) {
  if (is_bounced) light = bounced_behind;
}

#part shaded_sample
#include "lib/cells.glsl"

void bounced_light_prepare(inout Shaded s) {
  vec3 place = (frame.to_cells * vec4(eye_position(s.texel, s.mean.depth), 1.0)).xyz;
  float weight;
  bounced_here = cells_at(place, normalize(mat3(frame.to_cells) * s.normal), false, weight);
  if (weight == 0.0) bounced_here = cells_at(place, s.normal, true, weight);  // it is between things that touch
  is_bounced = weight >= 0.0;
  bounced_world = sent_irradiance(s.normal);
}

#part shaded_sample, through
void bounced_light_through_prepare(inout Shaded s) {
  vec3 place = (frame.to_cells * vec4(eye_position(s.texel, s.mean.depth), 1.0)).xyz;
  float weight;
  vec4 behind = cells_at(place, -normalize(mat3(frame.to_cells) * s.normal), false, weight);
  bounced_behind = weight > 0.0 ? behind.rgb : bounced_here.rgb;
}
