// References: Botsch et al. 2005, section 4 (what a splat blends).
// Summary: a stored splat as the attributes that every method accumulates. The includer says what `PARALLEL` (bool) is.

#include "common/sides.glsl"
#ifdef SPLIT
#include "common/split.glsl"
#endif
#include "common/stored_splat.glsl"

struct Splat {
  vec3 position;  // view space
  vec3 axis_u;    // half-axes, view space
  vec3 axis_v;
  vec4 color_weight;  // colour, and what the side that is seen weighs
  vec3 normal;        // shading normal on the side that is seen, view space
  float material;     // index
  float opacity;
  bool is_hidden;     // the back of a solid, or of no opacity
};

Splat fetch_splat(int index) {
  StoredSplat stored = stored_splat(index);
  mat3 linear = mat3(splats.model_view);
  Splat splat;
  splat.position = (splats.model_view * vec4(stored.position, 1.0)).xyz;
  splat.axis_u = linear * stored.axis_u;
  splat.axis_v = linear * stored.axis_v;
  splat.material = stored.material;
  float cosine = outward_cosine(splat.position, splat.axis_u, splat.axis_v, splats.sides.x, PARALLEL);
  splat.color_weight = vec4(stored.color.rgb, cosine < 0.0 ? BACK_WEIGHT : 1.0);
  splat.normal = normalize(mat3(splats.normal_matrix) * stored.normal);
  float side = cosine < 0.0 ? -splats.sides.x : splats.sides.x;
  if (dot(splat.normal, cross(splat.axis_u, splat.axis_v)) * side < 0.0) splat.normal = -splat.normal;
  splat.opacity = clamp(stored.color.a, 0.0, 1.0);
  splat.is_hidden = cosine < 0.0 && splats.sides.y > 0.5;
#ifdef SPLIT
  splat.is_hidden = splat.is_hidden || split_distance(splat.position) < splats.identity.z;
#endif
#ifdef LAYER
  splat.is_hidden = splat.is_hidden || splat.opacity < LEAST_OPACITY;
#endif
  return splat;
}
