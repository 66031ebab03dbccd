// References: Botsch et al. 2005, section 4 (sums over their weights).
// Summary: the surface that a sample sees. Hooks: `mean` of normals and depths, `join` adds other surfaces.

#include "lib/samples/{samples}.glsl"
#include "sum_formats/{sum_format}.glsl"
#include "lib/front_weight.glsl"

struct MeanSurface {
  float weight;  // sum of the splats' weights, 0 without splats
  float polygon;  // share of the polygon, 0 to 1
  float coverage;  // 0 if there is nothing; for a transparent layer its opacity
  float sees;  // divisor of polygons' texels
  vec3 color;
  vec3 normal;  // not normalised
  float depth;
};

#parts
// tap: number of the texel's hardware sample, 0 if it has only one.
MeanSurface mean_surface(ivec2 texel, int tap) {
  MeanSurface mean = MeanSurface(0.0, 0.0, 0.0, 1.0, vec3(0.0), vec3(0.0), 0.0);
  vec4 c = SUM_AT(gbuffer_color, texel, tap);
  if (c.w > 0.0) {
    float weights = c.w;
    vec4 n = SUM_AT(gbuffer_normal, texel, tap);
    #hook mean(weights, n, texel, tap)
    c.rgb = summed_color(c.rgb);
    mean = MeanSurface(weights, 0.0, min(c.w / weights, 1.0), 1.0, c.rgb / c.w, n.xyz, n.w);
  }
  #hook join(mean, texel, tap)
  return mean;
}
