// References: Christensen, "Point-Based Approximate Color Bleeding", 2008 (merged surfels receive light); McTaggart,
//             "Half-Life 2 / Valve Source Shading", 2004 (light on six sides, by the squares of a normal's components);
//             Teschner et al. 2003 (the hash).
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

#part shaded_sample
// What a side counts for at least, so that a surface of which no cell knows the sides that it faces has light too.
const float BOUNCED_LEAST = 1e-4;

vec4 bounced_texel(int number) {
  return texelFetch(bounced, ivec2(number % BOUNCED_PER_ROW, number / BOUNCED_PER_ROW), 0);
}

// The row of a cell in the table; -1 if it has none.
int bounced_row(ivec3 cell) {
  uint hash = uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u;
  int slots = int(frame.bounced_slots), probes = int(frame.bounced_probes);
  for (int k = 0; k < probes; k++) {
    vec4 slot = bounced_texel(int((hash + uint(k)) & uint(slots - 1)));
    if (!(slot.w > 0.0)) break;
    if (ivec3(slot.xyz) == cell) return int(slot.w) - 1;
  }
  return -1;
}

// What the cells around a place know of its sides, or of any sides. weight: negative where there are no cells.
vec4 bounced_at(vec3 place, vec3 normal, bool any_side, out float weight) {
  vec3 at = place - 0.5, low = floor(at), share = at - low;
  ivec3 sides = ivec3(0, 2, 4) + ivec3(lessThan(normal, vec3(0.0)));
  vec3 facing = max(normal * normal, vec3(BOUNCED_LEAST));
  vec4 total = vec4(0.0);
  float sum = 0.0;
  weight = -1.0;
  for (int k = 0; k < 8; k++) {
    ivec3 corner = ivec3(k & 1, k >> 1 & 1, k >> 2);
    vec3 near = mix(1.0 - share, share, vec3(corner));
    float own = near.x * near.y * near.z;
    if (!(own > 0.0)) continue;
    int row = bounced_row(ivec3(low) + corner);
    if (row < 0) continue;
    weight = 0.0;
    int first = int(frame.bounced_slots) + 6 * row;
    for (int i = 0; i < (any_side ? 6 : 3); i++) {
      vec4 side = bounced_texel(first + (any_side ? i : sides[i]));
      if (side.a < 0.0) continue;
      float counts = any_side ? own : own * facing[i];
      total += counts * side;
      sum += counts;
    }
  }
  weight = max(weight, sum);
  return total / max(sum, 1e-9);
}

void bounced_light_prepare(inout Shaded s) {
  vec3 place = (frame.to_cells * vec4(eye_position(s.texel, s.mean.depth), 1.0)).xyz;
  float weight;
  bounced_here = bounced_at(place, normalize(mat3(frame.to_cells) * s.normal), false, weight);
  if (weight == 0.0) bounced_here = bounced_at(place, s.normal, true, weight);  // it is between things that touch
  is_bounced = weight >= 0.0;
  bounced_world = sent_irradiance(s.normal);
}
