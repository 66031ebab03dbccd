// References: Botsch et al. 2005, section 4 (what a splat blends).
// Summary: reads a stored splat as the attributes that every method accumulates. Hooks: `choose` the splat of a
//          triangle, `unpack` further values, `hide` splats that are not drawn, `resize` others.

#include "lib/sides.glsl"
#include "lib/stored_splat.glsl"

struct Splat {
  vec3 position;  // view space
  vec3 axis_u;    // half-axes, view space
  vec3 axis_v;
  vec3 color;
  float side_weight;  // weight of the visible side
  float amplitude;    // of a widened kernel
  float shortened;    // factor of the axes of merged splats; 1 for others
  float grain;        // radius of the samples that a large surfel replaces, relative to its own; 1 for others
  vec3 normal;  // shading normal on the visible side, view space
  float material;     // index
  float opacity;
  bool is_back;
  bool is_hidden;  // not drawn: the back of a solid, fully transparent, or none of the object's
};

// Unit geometric normal on the visible side, view space.
vec3 geometric_normal(Splat splat) {
  vec3 outward = cross(splat.axis_u, splat.axis_v) * (splat.is_back ? -instance.orientation : instance.orientation);
  return outward / max(length(outward), 1e-37);
}

#parts
// Number of a triangle's splat.
int drawn_splat(int triangle) {
  int index = triangle;
  #hook choose(index)
  return index;
}

Splat fetch_splat(int index) {
  StoredSplat stored = stored_splat(index);
  #hook unpack(stored, index)
  mat3 linear = mat3(instance.model_view);
  Splat splat;
  splat.position = (instance.model_view * vec4(stored.position, 1.0)).xyz;
  splat.axis_u = linear * stored.axis_u;
  splat.axis_v = linear * stored.axis_v;
  splat.material = stored.material;
  float cosine = outward_cosine(splat.position, splat.axis_u, splat.axis_v, instance.orientation, view.is_parallel > 0.5);
  splat.color = stored.color.rgb;
  splat.side_weight = cosine < 0.0 ? BACK_WEIGHT : 1.0;
  splat.amplitude = splat.shortened = splat.grain = 1.0;
  // A shading normal belongs to the side that it is on in the object: stretching may carry it across the plane.
  bool is_inward = dot(stored.normal, cross(stored.axis_u, stored.axis_v)) < 0.0;
  splat.normal = normalize(mat3(instance.normal_matrix) * stored.normal) * (is_inward != cosine < 0.0 ? -1.0 : 1.0);
  splat.opacity = clamp(stored.color.a, 0.0, 1.0);
  splat.is_back = cosine < 0.0;
  splat.is_hidden = (cosine < 0.0 && instance.hides_backs > 0.5) || is_beyond_instance();
  #hook hide(splat)
  #hook resize(splat, index)
  return splat;
}
