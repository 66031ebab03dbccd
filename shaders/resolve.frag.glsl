// References: this project; the idea of taking the colour of a sub-sample from the nearest pixel that sees its surface
//             is Chajdas, McGuire, Luebke, "Subpixel Reconstruction Antialiasing", I3D 2011.
// Summary: colours inside a surface were filtered with their splats; here its silhouettes are. Of the samples around one,
//          those that see its own surface take its colour, others keep their own, empty ones have the background's, all
//          under the pixel's Gaussian. Where there are transparent layers, each counts by what the nearer ones let
//          through there.

#include "common/sample_outputs.glsl"
#ifdef LAYER
#define visibility_depth layer_depth
#include "common/layer_at.glsl"
#endif
#ifdef LAYERS
#include "common/before_layers.glsl"
#endif
#if defined(LAYER) || defined(LAYERS)
#define BEHIND_LAYERS
#include "common/peeled.glsl"
#endif

#define PROJECTION shading.projection
#define PARALLEL (shading.options.x > 0.5)
#define DEPTH_UNIT shading.options.z
#include "common/stored_depth.glsl"
#include "common/silhouette_filter.glsl"
#include "common/world.glsl"
#ifdef LAYER
const float FARTHEST = 3.4e38;
#else
#include "common/pixel.glsl"
#endif

// The Gaussian by forward differences: its first value, first ratio of neighbours, and how the ratio changes.
const float FIRST_WEIGHT = exp(-0.5 * float(FILTER_REACH * FILTER_REACH) / FILTER_VARIANCE);
const float FIRST_RATIO = exp((float(FILTER_REACH) - 0.5) / FILTER_VARIANCE);
const float RATIO_RATIO = exp(-1.0 / FILTER_VARIANCE);

float depth_at(ivec2 texel, ivec2 size, float otherwise) {
  vec4 s = texelFetch(surface, clamp(texel, ivec2(0), size - 1), 0);
  return s.w > 0.0 ? s.w : otherwise;
}

// What depth changes by from this sample to the next, across and up, on a plane of this normal.
vec2 plane_slope(ivec2 texel, vec3 normal, float depth) {
  vec2 place = shading.window.xy + (vec2(texel) + 0.5) * shading.window.zw;
  float facing = PARALLEL ? normal.z : (normal.z - dot(normal.xy, place)) / depth;
  return abs(normal.xy * shading.window.zw) / max(abs(facing), 1e-30);
}

// What visibility sees of the surface that is seen here, within the filter: nearest and farthest. On either side of its
// depth twice its slope, which is the lesser one of both sides and no more than its normal says: a silhouette on one
// side does not spoil it, nor do two, of a gap or a wire. Visibility moved all of it back, by up to twice as much as here;
// what is nearer lies before it, but for a part of that: surfels of one surface do not lie in one plane.
vec2 same_surface(ivec2 texel, ivec2 size, vec3 normal, float depth) {
  float moved = abs(view_depth(texelFetch(visibility_depth, texel, 0).r) - depth);
  vec2 before = vec2(depth_at(texel - ivec2(1, 0), size, 1e30), depth_at(texel - ivec2(0, 1), size, 1e30));
  vec2 after = vec2(depth_at(texel + ivec2(1, 0), size, 1e30), depth_at(texel + ivec2(0, 1), size, 1e30));
  vec2 slope = min(min(abs(before - depth), abs(after - depth)), plane_slope(texel, normal, depth));
  float sloped = 2.0 * (slope.x + slope.y);
  return vec2(max(depth - sloped - 0.25 * moved, 0.5 * depth), depth + sloped + 2.0 * moved);
}

// Nearest and farthest of all stored depths that the filter reaches from here.
vec2 reached_range(ivec2 texel, ivec2 size) {
  vec2 reached = vec2(1.0, 0.0);
  for (int y = -FILTER_REACH; y <= FILTER_REACH; y++) {
    vec2 row = texelFetch(seen_range, ivec2(texel.x, clamp(texel.y + y, 0, size.y - 1)), 0).xy;
    reached = vec2(min(reached.x, row.x), max(reached.y, row.y));
  }
  return reached;
}

// coverage: what is covered and not by nearer layers. first: the share of which this is the surface that depth and
// normal are of. is_hit: whether the texel sees such; is_behind: whether it is in a nearer layer.
vec4 resolve_sample(ivec2 texel, out float coverage, out float first, out bool is_hit, out bool is_behind,
                    out Outputs outputs) {
  ivec2 size = textureSize(shaded, 0);
  vec4 own = texelFetch(shaded, texel, 0);
  vec4 seen_surface = texelFetch(surface, texel, 0);
  float depth = seen_surface.w;
  // The range of stored depths that see the same surface; none where there is none.
  vec2 range = vec2(2.0, -1.0);
  if (own.w > 0.0) {
    vec2 same = same_surface(texel, size, seen_surface.xyz, depth);
    range = vec2(stored_depth(same.x), stored_depth(same.y));
  }
#ifdef LAYER
  const vec4 background = vec4(0.0);
#else
  vec4 background = world_background(texel);
#endif
  vec4 color = vec4(0.0);
  float total = 0.0;
  outputs = NO_OUTPUTS;
  coverage = 0.0;
  first = 0.0;
  is_hit = false;
  is_behind = false;
  // Inside a surface and beside all surfaces there is nothing to filter, and the loops have no turn to make.
  vec2 reached = reached_range(texel, size);
  bool is_inside = reached.x >= range.x && reached.y <= range.y && reached.y < 1.0;
#ifdef BEHIND_LAYERS
  is_inside = false;
#endif
#ifdef LAYERS
  bool is_even = false;
#else
  bool is_even = is_inside || reached.x == 1.0;
#endif
  if (is_even) {
    color = is_inside ? own : background;
    coverage = is_inside ? 1.0 : 0.0;
    first = coverage;
    total = 1.0;
    is_hit = is_inside;
    if (is_inside) outputs = sample_outputs(texel);
  }
  int across = is_even ? 0 : 2 * FILTER_REACH + 1;
  float row = FIRST_WEIGHT, row_ratio = FIRST_RATIO;
  for (int y = 0; y < across; y++) {
    float weight = row * FIRST_WEIGHT, ratio = FIRST_RATIO;
    for (int x = 0; x < across; x++) {
      ivec2 at = clamp(texel + ivec2(x, y) - FILTER_REACH, ivec2(0), size - 1);
      float seen = texelFetch(visibility_depth, at, 0).r;
      vec4 here = background;
      float shown = weight;
#ifdef BEHIND_LAYERS
      shown *= let_through(at);
      bool is_first = is_first_surface(at);
      is_behind = is_behind || (at == texel && !is_first);
#else
      const bool is_first = true;
#endif
#if defined(HOLDOUT) && !defined(LAYER)
      // What is seen and not shaded cuts a hole.
      bool is_cut = seen < 1.0 && !(texelFetch(shaded, at, 0).w > 0.0);
      if (is_cut) here = vec4(0.0);
#else
      const bool is_cut = false;
#endif
      if (seen < 1.0 && !is_cut) {
#ifdef LAYER
        bool is_own = seen >= range.x && seen <= range.y;
        here = layer_at(at);
        outputs = is_own ? added(outputs, sample_outputs(texel), shown * here.w / own.w)
                         : added(outputs, layer_outputs_at(at), shown);
        if (is_own) here = own * (here.w / own.w);
        is_first = is_first && here.w >= shading.edges.y;
#else
        vec4 there = texelFetch(shaded, at, 0);
        bool is_own = (seen >= range.x && seen <= range.y) || !(there.w > 0.0);
        here = is_own ? own : there;
        here = here.w > 0.0 ? here : background;
        outputs = added(outputs, sample_outputs(is_own ? texel : at), shown);
#endif
        coverage += shown;
        first += is_first ? weight : 0.0;
        is_hit = is_hit || (at == texel && is_first);
      }
      color += shown * here;
      total += weight;
      weight *= ratio;
      ratio *= RATIO_RATIO;
    }
    row *= row_ratio;
    row_ratio *= RATIO_RATIO;
  }
  coverage /= total;
  outputs = added(NO_OUTPUTS, outputs, 1.0 / total);
  first /= total;
  return color / total;
}

void main() {
  ivec2 origin = ivec2(gl_FragCoord.xy) * SAMPLES;
  vec4 color_total = vec4(0.0);
  vec4 normal_total = vec4(0.0);
  Outputs outputs_total = NO_OUTPUTS;
  float nearest = FARTHEST;
  bool is_seen_nearer = false;
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) {
      ivec2 texel = origin + ivec2(x, y);
      float coverage, first;
      bool is_hit, is_behind;
      Outputs outputs;
      color_total += resolve_sample(texel, coverage, first, is_hit, is_behind, outputs);
      outputs_total = added(outputs_total, outputs, 1.0);
      is_seen_nearer = is_seen_nearer || is_behind;
      vec4 s = texelFetch(surface, texel, 0);
      normal_total += vec4(s.xyz * first, coverage);
      if (is_hit && s.w > 0.0) nearest = min(nearest, s.w * shading.material.w);
    }
  }
  float share = 1.0 / float(SAMPLES * SAMPLES);
#ifdef LAYER
  layers = color_total * share;
  layers_depth = nearest < FARTHEST && !is_seen_nearer ? nearest : 0.0;
#ifdef LAYERS_NORMAL_OUTPUT
  layers_normal = vec4(mat3(shading.view_to_world) * normal_total.xyz, 0.0) * share;
#endif
  write_outputs(added(NO_OUTPUTS, outputs_total, share));
#else
  write_pixel(color_total * share, normal_total * share, nearest, added(NO_OUTPUTS, outputs_total, share));
#endif
}
