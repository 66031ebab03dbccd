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
  int start = corner / 3 * 3;
  vec2 seams = corner_uv_texel(start).zw + corner_uv_texel(start + 1).zw + corner_uv_texel(start + 2).zw;
  texture_triangle = seams != vec2(0.0) ? float(corner / 3) : -1.0;
  uv_gradient(start, first, gradient_u, gradient_v);
}

#part polygons.frag
#include "lib/corner_uv.glsl"
#include "lib/texture_lookup.glsl"
#include "lib/uv_change.glsl"

const float DEVIATIONS = 2.0;  // of a footprint, that count
const float TINY = 1e-6;       // texels, or their square
const float WIDEST = 1e6;      // footprint that is looked at, in texels

// Change of the texture coordinates per sample along x and y.
mat2 sample_uv_change() {
  return uv_change(gradient_u, gradient_v, view.window.xy + gl_FragCoord.xy * view.window.zw, depth_at);
}

// Leaves out what of a footprint lies beyond a line. middle, variances: of the footprint, in texels. inside: distance of
// the middle from the line. inward: unit. height: of the triangle above the line.
void end_footprint(inout vec2 middle, inout vec3 variances, float inside, vec2 inward, float height) {
  vec2 change = vec2(dot(variances.xz, inward), dot(variances.zy, inward));
  float variance = max(dot(inward, change), TINY), reach = DEVIATIONS * sqrt(variance);
  if (!(inside < reach && reach < WIDEST)) return;
  float most = max(min(inside + reach, height), TINY), kept = 0.5 * most / reach;
  middle += change * ((0.5 * most - inside) / variance);
  variances -= vec3(change * change, change.x * change.y) * ((1.0 - kept * kept) / variance);
}

// The footprint without what lies beyond the seams of the triangle's chart, where the image shows other surfaces.
void end_at_seams(SurfaceTexture t, inout vec2 uv, inout vec3 variances) {
  if (texture_triangle < 0.0) return;
  int start = 3 * int(texture_triangle);
  vec2 middle = uv * t.size;
  vec3 scale = vec3(t.size * t.size, t.size.x * t.size.y), spread = variances * scale;
  for (int k = 0; k < 3; k++) {
    vec4 corner = corner_uv_texel(start + k);
    vec2 place = corner.xy * t.size, first = corner_uv(start + (k + 1) % 3) * t.size;
    vec2 second = corner_uv(start + (k + 2) % 3) * t.size;
    if (corner.z > 0.0) {
      vec2 along = second - first, inward = place - first;
      inward -= along * (dot(along, inward) / max(dot(along, along), TINY));
      float height = max(length(inward), TINY);
      inward /= height;
      end_footprint(middle, spread, dot(middle - first, inward), inward, height);
    }
    if (corner.w > 0.0) {
      // Only a footprint that covers the corner reaches over it.
      vec2 inward = 0.5 * (first + second) - place, offset = middle - place;
      float height = max(length(inward), TINY);
      inward /= height;
      vec3 conic = vec3(spread.y, spread.x, -spread.z) / max(spread.x * spread.y - spread.z * spread.z, TINY * TINY);
      float deviations2 = dot(conic, vec3(offset * offset, 2.0 * offset.x * offset.y));
      float variance = dot(spread, vec3(inward * inward, 2.0 * inward.x * inward.y));
      end_footprint(middle, spread, sqrt(max(deviations2 * variance, 0.0)), inward, height);
    }
  }
  uv = middle / t.size;
  variances = spread / scale;
}

void textures_color(inout vec3 color) {
  if (texture_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(texture_slot));
  vec2 uv = texture_uv;
  vec3 variances = uv_variances(PIXEL_VARIANCE, sample_uv_change());
  end_at_seams(t, uv, variances);
  color = texture_color(t, uv, variances);
}
