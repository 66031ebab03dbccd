// References: Guennebaud et al. 2006, section 5.1; Heckbert, "Fundamentals of Texture Mapping", 1989 (the footprint of a
//             pixel on a plane, from the plane and not from differences, which drivers take differently).
// Summary: the attributes of the nearest polygon; for methods that compare depths in the shader, where splats do not
//          hide it.

#include "common/depth.glsl"
#ifdef SPLIT_POLYGONS
#include "common/split.glsl"
#endif
#ifdef TEXTURED
#include "common/texture_lookup.glsl"

const float LEAST_FACING = 1e-4;

// What a sample along x and y moves the texture coordinates.
mat2 uv_change(float depth) {
  vec2 point = splats.window.xy + gl_FragCoord.xy * splats.window.zw;
  bool is_orthographic = splats.options.z > 0.5;
  vec3 ray = is_orthographic ? vec3(0.0, 0.0, -1.0) : vec3(point, -1.0);
  float facing = dot(triangle_plane, ray);
  facing = abs(facing) > LEAST_FACING ? facing : (facing < 0.0 ? -LEAST_FACING : LEAST_FACING);
  float unit = is_orthographic ? 1.0 : depth;
  vec3 along_x = vec3(1.0, 0.0, 0.0) - ray * (triangle_plane.x / facing);
  vec3 along_y = vec3(0.0, 1.0, 0.0) - ray * (triangle_plane.y / facing);
  return mat2(dot(gradient_u, along_x), dot(gradient_v, along_x), dot(gradient_u, along_y), dot(gradient_v, along_y))
      * unit * mat2(splats.window.z, 0.0, 0.0, splats.window.w);
}
#endif

#ifdef SEEN_POLYGONS
// Visibility has other rows, by which a triangle that is clipped far outside of the picture is rounded otherwise: a floor
// of 10,000 eye heights by 5e-6.
const float ROUNDING = 3e-5;
#endif

void main() {
  if (!(depth_at >= splats.options.y)) discard;
#ifdef SPLIT_POLYGONS
  if (splats.identity.z > 0.0 && split_distance(split_place) > splats.identity.z) discard;
#endif
#ifdef SEEN_POLYGONS
  float seen = texelFetch(seen_range, ivec2(gl_FragCoord.xy), 0).z;
  if (depth_at > seen + ROUNDING * abs(seen)) discard;
#endif
  write_depth(depth_at);
  vec3 color = corner_color;
#ifdef TEXTURED
  if (texture_slot >= 0.0) {
    mat2 change = uv_change(depth_at);
    mat2 variance = PIXEL_VARIANCE * change * transpose(change);
    color = texture_color(surface_texture(int(texture_slot)), texture_uv,
                          vec3(variance[0].x, variance[1].y, variance[0].y));
  }
#endif
  polygon_color = vec4(color, 1.0);
  polygon_normal = vec4(normalize(corner_normal), depth_at);
#ifdef MATERIAL_OUTPUT
#ifdef MATERIAL_TARGET
  vec3 own = material;
#else
  vec3 own = vec3(0.0);
#endif
  polygon_material = vec4(own, dot(splats.light_set, vec4(0.0, 1.0, 2.0, 3.0)));
#endif
#ifdef PLANE_OUTPUT
  polygon_plane = vec4(triangle_plane, 0.0);
#endif
#ifdef EMISSION_TARGET
  polygon_emission = vec4(emission, 1.0);
#endif
#ifdef IDENTITY_TARGET
  polygon_identity = vec2(number, depth_at);
#endif
}
