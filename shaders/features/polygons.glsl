// References: Guennebaud et al. 2006, section 5.1 (the sum of the splats' weights, clamped to 1, blends them with polygons
//             of the same surface).
// Summary: polygons among splats. Where splats lie on a polygon and their weights sum to less than 1, at their border,
//          they blend into it; elsewhere the nearer of the two is visible.

#part polygons.frag, depth_bounds
// Visibility has additional rows, and a triangle that is clipped far outside the picture is rounded differently there.
// Hardware also moves corners to a grid of 1/256 pixel and interpolates between the moved ones, which shifts depths by up
// to as much of a pixel; four times that is left for it.
const float ROUNDING = 3e-5, GRID = 1.0 / 64.0;

// Where no splat hides it.
void polygons_keep() {
  float seen = texelFetch(depth_bounds, ivec2(gl_FragCoord.xy), 0).z;
  if (depth_at > seen + ROUNDING * abs(seen) + GRID * fwidth(depth_at)) discard;
}

#part mean_surface
#include "lib/polygon_share/{polygon_share}.glsl"
#include "lib/polygon_blend/{polygon_blend}.glsl"

float polygon_share(MeanSurface mean, vec3 normal, float depth) {
  float behind = depth - mean.depth;
  if (is_elsewhere(behind)) return behind > 0.0 ? 0.0 : 1.0;
  float weight = splat_weight(mean);
  // Splats of the same surface may be slightly behind a polygon and remain visible; for other splats the nearer surface
  // wins. Surfaces are the same whose normals have this cosine; as printed, all are.
  bool is_same = dot(normal, mean.normal) > SAME_SURFACE * length(mean.normal);
  return behind < 0.0 && !is_same ? 1.0 : 1.0 - min(weight, 1.0);
}

void polygons_join(inout MeanSurface mean, ivec2 texel, int tap) {
  keep_splats(mean);
  vec4 color = SUM_AT(polygon_color, texel, tap);
  if (!(color.a > 0.0)) return;
  vec4 normal = SUM_AT(polygon_normal, texel, tap);
  if (IS_MEAN) {
    mean.sees = color.a;
    normal /= color.a;
    color.rgb /= color.a;
    mean.coverage = max(mean.coverage, color.a);
  }
  else {
    mean.coverage = 1.0;
  }
  mean.polygon = mean.weight > 0.0 ? polygon_share(mean, normal.xyz, normal.w) : 1.0;
  mean.depth = mix(mean.depth, normal.w, mean.polygon);
  blend_with_polygon(mean, color.rgb, normal);
}
