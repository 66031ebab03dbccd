// References: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016;
//             Karis, "Real Shading in Unreal Engine 4", 2013 (the albedo in two terms);
//             Lagarde, de Rousiers, "Moving Frostbite to PBR", 2014, section 4.9.3 (the lobe's dominant direction);
//             Turquin, "Practical multiple scattering compensation for microfacet models", 2019.
// Summary: reads the table of the GGX lobe made by reference/brdf_fit.py. The twin of reference/brdf.py.

const vec2 TABLE_STEPS = vec2(31.0, 47.0);  // angles, roughnesses
const float TABLE_LEAST_ROUGHNESS = 0.03;

// In units of the table's texels.
vec2 table_place(float roughness, float cosine) {
  vec2 at = vec2(sqrt(max(1.0 - cosine, 0.0)), (roughness - TABLE_LEAST_ROUGHNESS) / (1.0 - TABLE_LEAST_ROUGHNESS));
  return clamp(at, 0.0, 1.0) * TABLE_STEPS;
}

// part 0: the transform's entries xx, xz, zx, zz; part 1: the albedo's terms, x and z of the mean direction.
vec4 table_at(float roughness, float cosine, int part) {
  vec2 at = table_place(roughness, cosine);
  ivec2 low = ivec2(min(at, TABLE_STEPS - 1.0)), first = ivec2(int(TABLE_STEPS.x + 1.0) * part, 0);
  vec2 share = at - vec2(low);
  vec4 below = mix(texelFetch(brdf_table, first + low, 0), texelFetch(brdf_table, first + low + ivec2(1, 0), 0), share.x);
  vec4 above = mix(texelFetch(brdf_table, first + low + ivec2(0, 1), 0),
                   texelFetch(brdf_table, first + low + ivec2(1, 1), 0), share.x);
  return mix(below, above, share.y);
}

// Albedo of the lobe under a uniform world, and the factor by which multiple scattering increases it. f90: reflectance
// at grazing incidence.
vec3 specular_albedo(vec2 terms, vec3 f0, float f90, out vec3 scattered) {
  scattered = 1.0 + f0 * (1.0 / max(terms.x + terms.y, 1e-3) - 1.0);
  return (f0 * terms.x + f90 * terms.y) * scattered;
}

// Mean direction of reflected light: off the mirrored direction, more so for rough surfaces and grazing views. The
// view's frame: see rendering/shading_models/brdf_table.py.
vec3 mean_direction(vec2 mean, vec3 to_eye, vec3 normal) {
  vec3 across = to_eye - normal * dot(to_eye, normal);
  return normalize(normal * mean.y + across * (mean.x / max(length(across), 1e-6)));
}

#part specular_tint
// The lobe's mean of c (1 - c)^6, where c is the cosine to the half vector.
float edge_at(float roughness, float cosine) {
  vec2 at = table_place(roughness, cosine);
  ivec2 low = ivec2(min(at, TABLE_STEPS - 1.0));
  vec2 share = at - vec2(low);
  float below = mix(texelFetch(edge_table, low, 0).x, texelFetch(edge_table, low + ivec2(1, 0), 0).x, share.x);
  float above = mix(texelFetch(edge_table, low + ivec2(0, 1), 0).x, texelFetch(edge_table, low + ivec2(1, 1), 0).x, share.x);
  return mix(below, above, share.y);
}

#part sized_lights
// Angle of the great circle between two directions, times the z of its normal.
float edge(vec3 from, vec3 to) {
  vec3 a = normalize(from), b = normalize(to);
  vec3 normal = cross(a, b);
  float sine = length(normal);
  return sine > 0.0 ? normal.z * atan(sine, dot(a, b)) / sine : 0.0;
}

// Below this ratio of half-axes to distance a quad is treated as a point with its area, because the sum over its edges
// suffers from cancellation.
const float SMALL_QUAD = 0.02;

// Share of the half-space's cosine-weighted light that comes through the quad middle +- u +- v, without the part below
// the horizon. Each edge counts by its part above the horizon, and so does the horizon between the points where the
// quad crosses it.
float form_factor(vec3 middle, vec3 u, vec3 v) {
  float distance2 = dot(middle, middle);
  if (max(dot(u, u), dot(v, v)) < SMALL_QUAD * SMALL_QUAD * distance2) {
    return max(middle.z, 0.0) * 4.0 * abs(dot(middle, cross(u, v))) / (3.14159265358979 * distance2 * distance2);
  }
  vec3 corners[4] = vec3[4](middle - u - v, middle + u - v, middle + u + v, middle - u + v);
  float sum = 0.0;
  vec3 leaves = vec3(0.0), returns = vec3(0.0);
  bool is_cut = false;
  for (int i = 0; i < 4; i++) {
    vec3 a = corners[i], b = corners[(i + 1) & 3];
    bool above_a = a.z >= 0.0, above_b = b.z >= 0.0;
    if (!above_a && !above_b) continue;
    vec3 crossing = vec3(mix(a.xy, b.xy, a.z / (a.z - b.z)), 0.0);
    if (above_a && !above_b) leaves = crossing;
    if (!above_a && above_b) returns = crossing;
    is_cut = is_cut || above_a != above_b;
    sum += edge(above_a ? a : crossing, above_b ? b : crossing);
  }
  if (is_cut) sum += edge(leaves, returns);
  return abs(sum) / (2.0 * 3.14159265358979);
}
