// References: hosts/resolve.frag.glsl.
// Summary: the filtered opaque picture: samples on the same surface show its colour, others keep their own, and empty
//          ones show the background.

#part resolve.frag
#include "lib/background/{background}.glsl"

void picture_show(inout Resolved sum, inout Seen s, Own own) {
  bool is_own = (s.level >= own.range.x && s.level <= own.range.y && s.is_smooth) || !(s.there.w > 0.0);
  s.here = is_own ? own.color : s.there;
  s.here = s.here.w > 0.0 ? s.here : s.background;
  sum.outputs = added(sum.outputs, sample_outputs(is_own ? own.shaded_at : s.at), s.shown);
}

void picture_background(inout vec4 background, ivec2 texel) {
  background = world_background(texel);
}

#include "hosts/pixel.glsl"

void picture_pixel(vec4 color, vec4 normal, float nearest, bool is_seen_nearer, Outputs outputs, float share) {
  write_pixel(color * share, normal * share, nearest, added(NO_OUTPUTS, outputs, share));
}

#part deferred_lighting.frag
// Sums of weights below this come from backs and from the tails of filters. Their depth is stored with a negative sign.
const float FAINT = 0.004;

void picture_sign(MeanSurface mean) {
  if (mean.polygon == 0.0 && mean.weight < FAINT * WEIGHT_SCALE) surface.w = -surface.w;
}
