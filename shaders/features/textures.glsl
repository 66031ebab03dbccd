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
// Change of the texture coordinates along each axis of view space, in the triangle's plane.
void texture_gradient(int start, vec3 first, vec3 outward) {
  vec3 along = corner_position(start + 1) - first, beside = corner_position(start + 2) - first;
  vec2 uv = texelFetch(polygon_uvs, ivec2(start % CORNERS_PER_ROW, start / CORNERS_PER_ROW), 0).xy;
  vec2 to_along = texelFetch(polygon_uvs, ivec2((start + 1) % CORNERS_PER_ROW, (start + 1) / CORNERS_PER_ROW), 0).xy - uv;
  vec2 to_beside = texelFetch(polygon_uvs, ivec2((start + 2) % CORNERS_PER_ROW, (start + 2) / CORNERS_PER_ROW), 0).xy - uv;
  vec3 plane = cross(along, beside);
  float square = max(dot(plane, plane), 1e-37);
  vec3 dual_along = cross(beside, plane) / square, dual_beside = cross(plane, along) / square;
  gradient_u = to_along.x * dual_along + to_beside.x * dual_beside;
  gradient_v = to_along.y * dual_along + to_beside.y * dual_beside;
}

void textures_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  int row = min(int(slot), textureSize(texture_table, 0).y - 1);
  texture_slot = texelFetch(texture_table, ivec2(0, row), 0).w > 0.0 ? float(row) : -1.0;
  texture_uv = texelFetch(polygon_uvs, ivec2(corner % CORNERS_PER_ROW, corner / CORNERS_PER_ROW), 0).xy;
  texture_gradient(corner / 3 * 3, first, outward);
}

#part polygons.frag
#include "lib/texture_lookup.glsl"

const float LEAST_PLANE_FACING = 1e-4;

// Change of the texture coordinates per sample along x and y.
mat2 uv_change(float depth) {
  vec2 point = view.window.xy + gl_FragCoord.xy * view.window.zw;
  bool is_orthographic = view.is_parallel > 0.5;
  vec3 ray = is_orthographic ? vec3(0.0, 0.0, -1.0) : vec3(point, -1.0);
  float facing = dot(triangle_plane, ray);
  facing = abs(facing) > LEAST_PLANE_FACING ? facing : (facing < 0.0 ? -LEAST_PLANE_FACING : LEAST_PLANE_FACING);
  float unit = is_orthographic ? 1.0 : depth;
  vec3 along_x = vec3(1.0, 0.0, 0.0) - ray * (triangle_plane.x / facing);
  vec3 along_y = vec3(0.0, 1.0, 0.0) - ray * (triangle_plane.y / facing);
  return mat2(dot(gradient_u, along_x), dot(gradient_v, along_x), dot(gradient_u, along_y), dot(gradient_v, along_y))
      * unit * mat2(view.window.z, 0.0, 0.0, view.window.w);
}

void textures_color(inout vec3 color) {
  if (texture_slot < 0.0) return;
  mat2 change = uv_change(depth_at);
  mat2 variance = PIXEL_VARIANCE * change * transpose(change);
  color = texture_color(surface_texture(int(texture_slot)), texture_uv,
                        vec3(variance[0].x, variance[1].y, variance[0].y));
}
