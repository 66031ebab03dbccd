// References: Guennebaud, Barthe, Paulin 2006, section 6 (depth peeling of splats).
// Summary: transparent layers, nearest first: their work in each pass of a layer (layer), and their effect on the
//          opaque picture (opaque).

#part splat, layer
void transparency_hide(inout Splat splat) {
  splat.is_hidden = splat.is_hidden || splat.opacity < LEAST_OPACITY;
}

#part splat_varyings, gbuffer
void transparency_tell(Splat splat, int index) {
  opacity = splat.opacity;
}

#part gbuffer, gbuffer, layer
void transparency_weigh(inout Fragment f) {
  f.opacity = opacity;
}

#part visibility.frag, layer
#include "lib/layer_sample.glsl"
void transparency_keep() {
  if (!is_in_layer(place_depth.z, 0.0, ivec2(gl_FragCoord.xy))) discard;
}

#part object_space.frag, layer
#include "lib/layer_sample.glsl"
void transparency_keep() {
  if (!is_in_layer(layer_depth(), 0.5, ivec2(gl_FragCoord.xy))) discard;
}

#part screen_space.frag, layer
#include "depth_formats/{depth_format}.glsl"
#include "lib/layer_ties.glsl"

// As in lib/peel_state.glsl; layers compare depth along the view, and so does this.
bool is_in_nearer_layer(float depth) {
  float until = texelFetch(peel_state, ivec2(gl_FragCoord.xy), 0).x;
  return until > 0.0 && (until == 1.0 || depth <= view_depth(until));
}

void transparency_keep(inout Candidate c) {
  // Where a filter reaches over its rim, a splat is in the same layers as the rim itself.
  float rim = length(c.plane.slope);
  if (!c.in_space) c.compared = clamp(c.compared, c.plane.depth - rim, c.plane.depth + rim);
  if (tied(c.compared, -0.5) > c.seen.z) discard;
  if (is_in_nearer_layer(tied(c.compared, 0.5))) discard;
}

#part depth_bounds.frag, layer
// Never behind the opaque surface there.
void transparency_write(ivec2 texel, inout float own) {
  own = min(own, texelFetch(visibility_depth, texel, 0).r);
}

#part shading.frag
#include "lib/peel_state.glsl"
void transparency_count(ivec2 texel, inout float through, inout bool is_first) {
  through = let_through(texel);
  is_first = is_first_surface(texel);
}

#part pixel
#include "hosts/before_layers.glsl"
void transparency_before(inout vec4 color, inout vec4 normal, inout float nearest, inout Outputs outputs) {
  put_layers_before(color, normal, nearest, outputs);
}

#part resolve.frag
#include "lib/peel_state.glsl"
void transparency_count(inout Resolved sum, inout Seen s) {
  s.shown *= let_through(s.at);
  s.is_first = is_first_surface(s.at);
  sum.is_behind = sum.is_behind || (s.is_self && !s.is_first);
}

#part resolve.frag, opaque
void transparency_everywhere(inout bool is_inside, inout bool is_beside) {
  is_inside = is_beside = false;
}

#part resolve.frag, layer
#include "lib/layer_at.glsl"

void transparency_everywhere(inout bool is_inside, inout bool is_beside) {
  is_inside = false;
}

void transparency_show(inout Resolved sum, inout Seen s, Own own) {
  bool is_own = s.level >= own.range.x && s.level <= own.range.y;
  s.here = layer_at(s.at);
  if (is_own) sum.outputs = added(sum.outputs, sample_outputs(own.shaded_at), s.shown * s.here.w / own.color.w);
  else sum.outputs = added(sum.outputs, layer_outputs_at(s.at), s.shown);
  if (is_own) s.here = own.color * (s.here.w / own.color.w);
  s.is_first = s.is_first && s.here.w >= frame.alpha_threshold;
}

#include "hosts/layer_pixel.glsl"

void transparency_pixel(vec4 color, vec4 normal, float nearest, bool is_seen_nearer, Outputs outputs, float share) {
  write_layer(color, normal.xyz, nearest, is_seen_nearer, outputs, share);
}
