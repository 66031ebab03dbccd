// References: Guennebaud et al. 2006, section 5.1 (the sum of the splats' weights, clamped to 1, blends them with polygons
//             of the same surface; attributes, not colours).
// Summary: polygons among splats. Where splats lie on a polygon and their weights sum to less than 1, at their border, they
//          go over into it; where they do not lie on it, the nearer of the two is seen.

#part polygons.frag, depth_bounds
// Visibility has other rows, by which a triangle that is clipped far outside of the picture is rounded otherwise: a floor
// of 10,000 eye heights by 5e-6.
const float ROUNDING = 3e-5;

// Where splats do not hide it.
void polygons_keep() {
  float seen = texelFetch(depth_bounds, ivec2(gl_FragCoord.xy), 0).z;
  if (depth_at > seen + ROUNDING * abs(seen)) discard;
}

#part mean_surface
#include "lib/polygon_share/{polygon_share}.glsl"

const float SAME_SURFACE = 0.7;  // least cosine between normals of one surface

float polygon_share(MeanSurface mean, vec3 normal, float depth) {
  float behind = depth - mean.depth;
  if (is_elsewhere(behind)) return behind > 0.0 ? 0.0 : 1.0;
  float weight = splat_weight(mean);
  // Splats may be seen from a little behind a polygon, so that those of its own surface are; of others the nearer wins.
  bool is_same = dot(normal, mean.normal) > SAME_SURFACE * length(mean.normal);
  return behind < 0.0 && !is_same ? 1.0 : 1.0 - min(weight, 1.0);
}

void polygons_join(inout MeanSurface mean, ivec2 texel, int tap) {
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
  mean.color = mix(mean.color, color.rgb, mean.polygon);
  mean.normal = mix(mean.normal, normal.xyz, mean.polygon);
  mean.depth = mix(mean.depth, normal.w, mean.polygon);
}
