// References: Blender manual, "Holdout".
// Summary: objects that cut holes. Where a holdout is the first visible surface, there is a depth but nothing to shade,
//          or only surfaces farther away.

#part screen_space.frag
// A splat in front of a hole must itself be in front; where a filter reaches over its rim, the plane of a grazing splat
// extends far forward.
void holdout_keep(inout Candidate c) {
  if (!(c.seen.w > 1e38)) return;
  if (!c.in_space && c.plane.depth - length(c.plane.slope) > c.seen.z) discard;
  c.seen.w = c.seen.z;
}

#part depth_bounds.frag
void holdout_bound(ivec2 texel, float own) {
  if (own < 1.0 && texelFetch(holes, ivec2(texel.x, ROWS * texel.y), 0).r <= own) depth_bounds.w = NOTHING_SEEN;
}

#part shading.frag
#include "lib/hole.glsl"
void holdout_cut(MeanSurface mean, ivec2 texel, int tap, inout bool is_cut) {
  is_cut = is_hole(texel, tap, mean);
}

#part deferred_lighting.frag
#include "lib/hole.glsl"
void holdout_cut(inout MeanSurface mean, ivec2 texel) {
  if (is_hole(texel, 0, mean)) mean.coverage = 0.0;
}

#part resolve.frag
// A visible surface that is not shaded cuts a hole.
void holdout_cut(inout Seen s) {
  s.is_cut = s.stored < 1.0 && !(s.there.w > 0.0);
  if (s.is_cut) s.here = vec4(0.0);
}
