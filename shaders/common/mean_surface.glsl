// References: Botsch et al. 2005, section 4 (sums over their weights); Guennebaud et al. 2006, section 5.1 (the sum of the
//             splats' weights, clamped to 1, blends them with polygons of the same surface; attributes, not colours).
// Summary: what a sample sees, of splats and polygons. Where splats lie on a polygon and their weights sum to less than
//          1, at their border, they go over into it; where they do not lie on it, the nearer of the two is seen.

#include "common/sum_at.glsl"
#include "common/weight_scale.glsl"
#include "common/sides.glsl"

struct MeanSurface {
  float weight;    // sum of the splats', 0 without splats
  float polygon;   // its share, 0 to 1
  float coverage;  // 0 where there is neither, of a transparent layer its opacity
  float sees;      // what polygons' texels are divided by
  vec3 color;
  vec3 normal;     // as the mean left it
  float depth;
};

// Weights of backs sum to less; the rim of a front weighs 0.135, or a quarter of it in the mean of four samples.
const float LEAST_FRONT = 0.02;

float front_weight(float sum) {
  float weight = sum / WEIGHT_SCALE;
  return weight < LEAST_FRONT ? weight / BACK_WEIGHT : weight;
}

#ifdef POLYGONS
const float SAME_SURFACE = 0.7;  // least cosine between normals of one surface

float polygon_share(MeanSurface mean, vec3 normal, float depth) {
  float behind = depth - mean.depth;
#ifdef SEEN_POLYGONS
  // Those that splats hide are not there. What is filtered has tails that weigh no more than backs.
  float weight = mean.weight / WEIGHT_SCALE;
#else
  if (behind > shading.edges.z) return 0.0;
  if (behind < -shading.edges.z) return 1.0;
  float weight = front_weight(mean.weight);
#endif
  // Splats may be seen from a little behind a polygon, so that those of its own surface are; of others the nearer wins.
  bool is_same = dot(normal, mean.normal) > SAME_SURFACE * length(mean.normal);
  return behind < 0.0 && !is_same ? 1.0 : 1.0 - min(weight, 1.0);
}
#endif

// look: which of the texel's hardware samples, 0 where it has one.
MeanSurface mean_surface(ivec2 texel, int look) {
  MeanSurface mean = MeanSurface(0.0, 0.0, 0.0, 1.0, vec3(0.0), vec3(0.0), 0.0);
  vec4 c = SUM_AT(color_sum, texel, look);
  if (c.w > 0.0) {
    float weights = c.w;
#ifdef DEPTH_SUM
    vec2 depths = SUM_AT(depth_sum, texel, look).xy;
#endif
#ifdef LAYER
    weights = depths.y;
#endif
    vec4 n = SUM_AT(normal_sum, texel, look) / weights;
#ifdef DEPTH_SUM
    n.w = depths.x / depths.y;
#endif
#ifdef HALF_SUMS
    c.rgb *= shading.options.w;
#endif
    mean = MeanSurface(weights, 0.0, min(c.w / weights, 1.0), 1.0, c.rgb / c.w, n.xyz, n.w);
  }
#ifdef POLYGONS
  vec4 color = SUM_AT(polygon_color, texel, look);
  if (color.a > 0.0) {
    vec4 normal = SUM_AT(polygon_normal, texel, look);
#ifdef MEAN_OF
    mean.sees = color.a;
    normal /= color.a;
    color.rgb /= color.a;
    mean.coverage = max(mean.coverage, color.a);
#else
    mean.coverage = 1.0;
#endif
    mean.polygon = mean.weight > 0.0 ? polygon_share(mean, normal.xyz, normal.w) : 1.0;
    mean.color = mix(mean.color, color.rgb, mean.polygon);
    mean.normal = mix(mean.normal, normal.xyz, mean.polygon);
    mean.depth = mix(mean.depth, normal.w, mean.polygon);
  }
#endif
  return mean;
}
