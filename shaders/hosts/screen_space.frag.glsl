// References: as screen_space.vert.glsl.
// Summary: evaluates the method's weight and depth, and adds the splat if it is not hidden at the sample's centre.
//          Depth is compared here with that of the visibility pass, because a triangle in the picture has no depth of
//          its own. Hooks: `weigh` for splats evaluated in space, `bound` changes how far is visible, `keep` discards,
//          `color` changes the colour, `add` fills targets.

#include "lib/instances/{instances}.glsl"
#include "hosts/gbuffer.glsl"
#include "lib/place.glsl"
#include "methods/{method}.glsl"

struct Candidate {
  Plane plane;
  bool in_space;   // evaluated in space, unfiltered
  vec3 place;  // position in the ellipse and depth, if in_space
  float weight;
  float depth;
  float compared;  // compared with the visible depths
  vec4 seen;  // depths: range of the filter, limit of what hides, limit of what is hidden
  vec3 color;
};

bool is_on_footprint() {
  vec2 d = gl_FragCoord.xy - plane_center_gh.xy - footprint_middle;
  vec2 at = d.x * footprint_map.xy + d.y * footprint_map.yz;
  return at.x >= -1.0 && at.x + 1.7320508 * abs(at.y) <= 2.0 && dot(at, at) <= FOOTPRINT_END * FOOTPRINT_END;
}

#parts
void main() {
  begin_fragment();
  Plane plane = Plane(plane_center_gh.xy, plane_ab.xy, plane_ab.zw, plane_center_gh.zw, plane_depths.xy, plane_depths.z,
                      plane_depths.w, plane_det_radius.w, plane_det_radius.xyz);
  Candidate c = Candidate(plane, false, vec3(0.0), 0.0, 0.0, 0.0, vec4(0.0), color_weight.rgb);
  #hook weigh(c)
  if (!c.in_space) {
    vec2 weight_depth = splat_sample(c.plane, gl_FragCoord.xy);
    c.weight = weight_depth.x;
    c.depth = weight_depth.y;
  }
  c.weight *= color_weight.w;
  if (!(c.weight > 0.0 && is_on_footprint() && c.depth >= view.near)) discard;
  c.compared = c.depth;
  #hook bound(c)
  #hook keep(c)
  #hook color(c)
  #hook add(c)
}
