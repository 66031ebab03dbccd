// References: lib/splat_texture.glsl, lib/texture_lookup.glsl.
// Summary: texture lookups for the colours of splats and polygons.

#part splat_varyings
#include "lib/splat_texture.glsl"
void textures_tell(Splat splat, int index) {
  texture_place = fetch_texture_place(index, splat.material, texture_along, texture_border);
}

#part object_space.vert
// Coordinates change along widened axes as along the splat's own.
void textures_axes(Splat splat, mat2 widened) {
  texture_axis_u = splat.axis_u;
  texture_axis_v = splat.axis_v;
  mat2 along = mat2(texture_along.xy, texture_along.zw) * widened;
  texture_along = vec4(along[0], along[1]);
  texture_border = texture_border * widened;
}

#part object_space.frag
#include "lib/splat_texture.glsl"
void textures_color(inout vec3 color) {
  vec2 point = view.window.xy + gl_FragCoord.xy * view.window.zw;
  mat2 change = space_place_change(texture_axis_u, texture_axis_v, point, place_depth.z);
  color = splat_texture_color(color_weight.rgb, texture_place, texture_along, texture_border, place_depth.xy, change);
}

#part screen_space.vert
// Replaced axes are mapped to the picture like others in the true plane.
void textures_replaced(Plane true_plane, Plane plane, bool in_space) {
  if (true_plane.a != plane.a || true_plane.b != plane.b) {
    mat2 to_true = inverse(mat2(true_plane.a, true_plane.b)) * mat2(plane.a, plane.b);
    mat2 along = mat2(texture_along.xy, texture_along.zw) * to_true;
    texture_along = vec4(along[0], along[1]);
    texture_border = texture_border * to_true;
  }
}

#part screen_space.frag
#include "lib/splat_texture.glsl"
void textures_color(inout Candidate c) {
  Place place = place_at(c.plane, gl_FragCoord.xy);
  // Beyond the plane's horizon only the splat's mean is meaningful.
  vec2 q = place.k > 0.0 ? place.uv : vec2(LARGEST_PIXEL);
  mat2 change = place.scale * place_turn(c.plane, place);
  if (c.in_space) {
    q = c.place.xy;
    vec2 point = view.window.xy + gl_FragCoord.xy * view.window.zw;
    change = space_place_change(plane_center_gh.xyz, plane_depths.xyz, point, c.place.z);
  }
  c.color = splat_texture_color(color_weight.rgb, texture_place, texture_along, texture_border, q, change);
}

#part polygons.vert
#include "lib/uv_gradient.glsl"

void textures_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  texture_slot = texture_slot_of(slot);
  texture_uv = corner_uv(corner);
  uv_gradient(corner / 3 * 3, first, gradient_u, gradient_v);
}

#part polygons.frag
#include "lib/texture_lookup.glsl"
#include "lib/uv_change.glsl"

// Change of the texture coordinates per sample along x and y.
mat2 sample_uv_change() {
  return uv_change(gradient_u, gradient_v, view.window.xy + gl_FragCoord.xy * view.window.zw, depth_at);
}

void textures_color(inout vec3 color) {
  if (texture_slot < 0.0) return;
  color = texture_color(surface_texture(int(texture_slot)), texture_uv, uv_variances(PIXEL_VARIANCE, sample_uv_change()));
}
