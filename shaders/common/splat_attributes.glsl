// References: Botsch et al. 2005, section 4 (what a splat blends).
// Summary: a splat's texels as the attributes that every method accumulates.

#include "common/octahedron.glsl"
#include "common/sides.glsl"
#include "common/splat_fetch.glsl"

struct Splat {
  vec3 position;  // view space
  vec3 axis_u;    // half-axes, view space
  vec3 axis_v;
  vec4 color_weight;  // colour, and what the side that is seen weighs
  vec3 normal;        // shading normal on the side that is seen, view space
  float material;     // index
  bool is_hidden;     // the back of a solid
};

Splat fetch_splat(int index) {
  ivec2 texel = splat_texel(index);
  vec4 position_data = texelFetch(surfels, texel, 0);
  vec4 u_data = texelFetch(surfels, texel + ivec2(1, 0), 0);
  vec4 v_data = texelFetch(surfels, texel + ivec2(2, 0), 0);
  mat3 linear = mat3(splats.model_view);
  Splat splat;
  splat.position = (splats.model_view * vec4(position_data.xyz, 1.0)).xyz;
  splat.axis_u = linear * u_data.xyz;
  splat.axis_v = linear * v_data.xyz;
  splat.material = v_data.w;
  float cosine = outward_cosine(splat.position, splat.axis_u, splat.axis_v, splats.sides.x, splats.options.z > 0.5);
  splat.color_weight = vec4(texelFetch(surfels, texel + ivec2(3, 0), 0).rgb, cosine < 0.0 ? BACK_WEIGHT : 1.0);
  splat.normal = normalize(mat3(splats.normal_matrix) * octahedral_decode(vec2(position_data.w, u_data.w)));
  float side = cosine < -GRAZING_COSINE ? -splats.sides.x : splats.sides.x;
  if (dot(splat.normal, cross(splat.axis_u, splat.axis_v)) * side < 0.0) splat.normal = -splat.normal;
  splat.is_hidden = cosine < 0.0 && splats.sides.y > 0.5;
  return splat;
}
