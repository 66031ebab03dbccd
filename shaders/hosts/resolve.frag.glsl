// References: this project; the idea of taking the colour of a sub-sample from the nearest pixel that sees its surface
//             is Chajdas, McGuire, Luebke, "Subpixel Reconstruction Antialiasing", I3D 2011.
// Summary: filters silhouettes; colours inside a surface were filtered with their splats already. Of the neighbouring
//          samples, and of what visibility sees halfway to the next rows, those that see this sample's surface take its
//          colour, all under the pixel's Gaussian. Hooks: `background` behind them, `everywhere` if nothing may remain
//          unfiltered, `count` weights by what is in front of a sample, `cut` removes visible surfaces that are not
//          shown, `show` changes a colour, `pixel` writes further outputs.

#include "hosts/sample_outputs.glsl"
#include "depth_formats/{depth_format}.glsl"
#include "lib/silhouette_filter.glsl"

#include "lib/farthest.glsl"

const float STEP = 1.0 / float(ROWS);

// Minimum cosine between normals of the same surface: across a sharper crease, surfels of either side protrude from the
// other. The value avoids angles of common solids, such as 60 or 63 degrees, where rounding would decide.
const float SMOOTH = 0.55;

// Depths belong to the same surface if they are nearer or farther than its plane by at most this many times as much as
// visibility moved it, plus this share of its slope. Nothing is filtered where the neighbouring samples belong to it, and
// all that the filter reaches is within that and this many slopes more.
const vec2 MOVED = vec2(0.5, 2.0);
const float BENT = 0.5;
const vec2 REACHED = vec2(0.75, 2.25);

// Normal and depth of the shaded sample; if there is none, this normal and a depth beyond everything.
vec4 surface_at(ivec2 texel, ivec2 size, vec3 normal) {
  vec4 s = texelFetch(surface, clamp(texel, ivec2(0), size - 1), 0);
  return s.w != 0.0 ? vec4(s.xyz, abs(s.w)) : vec4(normal, 1e30);
}

// Change of depth to the next sample across and up, on a plane with this normal.
vec2 plane_slope(ivec2 texel, vec3 normal, float depth) {
  vec2 place = view.window.xy + (vec2(texel) + 0.5) * view.window.zw;
  float facing = view.is_parallel > 0.5 ? normal.z : (normal.z - dot(normal.xy, place)) / depth;
  return normal.xy * view.window.zw / (facing < 0.0 ? min(facing, -1e-30) : max(facing, 1e-30));
}

// The smaller one of the changes of depth before and after a sample, but at most what its normal implies, so that a
// silhouette on one side does not spoil it, and neither do two, at a gap or a wire.
float least_change(float before, float after, float implied) {
  float least = abs(before) < abs(after) ? before : after;
  return abs(least) < abs(implied) ? least : implied;
}

// The surface that is shaded at a sample, with depths along the view. room: how much nearer and farther than its plane
// it may be. slope: its change to the next sample across and up. is_folded: a neighbouring sample is on the other side
// of a crease. is_even: the neighbouring samples see it too.
struct SameSurface {
  float depth;
  vec2 room;
  vec2 slope;
  bool is_folded;
  bool is_even;
};

// Visibility moved the surface back by up to twice as much as here; what is nearer is in front of it, except for a
// tolerance, because surfels of one surface do not lie in one plane.
SameSurface same_surface(ivec2 texel, ivec2 size, vec3 normal, float depth) {
  float moved = abs(view_depth(texelFetch(seen_depth, ivec2(texel.x, ROWS * texel.y), 0).r) - depth);
  vec4 left = surface_at(texel - ivec2(1, 0), size, normal), below = surface_at(texel - ivec2(0, 1), size, normal);
  vec4 right = surface_at(texel + ivec2(1, 0), size, normal), above = surface_at(texel + ivec2(0, 1), size, normal);
  vec4 smooth_to = vec4(dot(left.xyz, normal), dot(right.xyz, normal), dot(below.xyz, normal), dot(above.xyz, normal));
  vec2 before = depth - vec2(left.w, below.w), after = vec2(right.w, above.w) - depth;
  vec2 implied = plane_slope(texel, normal, depth);
  vec2 slope = vec2(least_change(before.x, after.x, implied.x), least_change(before.y, after.y, implied.y));
  vec2 room = MOVED * moved + BENT * (abs(slope.x) + abs(slope.y));
  vec4 off = vec4(slope - before, after - slope);
  bool is_even = all(greaterThan(off, vec4(-room.x))) && all(lessThan(off, vec4(room.y)));
  return SameSurface(depth, room, slope, any(lessThan(smooth_to, vec4(SMOOTH))), is_even);
}

// Whether all depths that the filter reaches are so close to a surface that nothing is filtered.
bool is_all(SameSurface same, vec2 reached) {
  vec2 room = same.room + dot(REACHED, abs(same.slope));
  return reached.x >= stored_depth(max(same.depth - room.x, 0.5 * same.depth)) &&
      reached.y <= stored_depth(same.depth + room.y);
}

// Range of stored depths of a surface.
vec2 stored_range(SameSurface same) {
  return vec2(stored_depth(max(same.depth - same.room.x, 0.5 * same.depth)), stored_depth(same.depth + same.room.y));
}

// Change of a surface's stored depth to the next sample; exact for hardware depth, which is affine on planes.
vec2 stored_slope(SameSurface same) {
  vec2 half_slope = clamp(0.5 * same.slope, -0.125 * same.depth, 0.125 * same.depth);
  return vec2(stored_depth(same.depth + half_slope.x) - stored_depth(same.depth - half_slope.x),
              stored_depth(same.depth + half_slope.y) - stored_depth(same.depth - half_slope.y));
}

// Minimum and maximum of all stored depths that the filter reaches from here.
vec2 reached_range(ivec2 texel, ivec2 size) {
  vec2 reached = vec2(1.0, 0.0);
  for (int y = -FILTER_REACH; y <= FILTER_REACH; y++) {
    vec2 row = texelFetch(depth_bounds, ivec2(texel.x, clamp(texel.y + y, 0, size.y - 1)), 0).xy;
    reached = vec2(min(reached.x, row.x), max(reached.y, row.y));
  }
  return reached;
}

// If a sample is empty or faint, use the nearest one that sees something: over an edge, surfels of the far side
// protrude, only their backs reach there, and the surface to filter is the near side.
ivec2 shaded_at(ivec2 texel, ivec2 size) {
  ivec2 found = texel;
  bool is_faint = texelFetch(surface, texel, 0).w < 0.0 && texelFetch(seen_depth, ivec2(texel.x, ROWS * texel.y), 0).r == 1.0;
  int taps = is_faint ? 9 : 0, nearest = 9;
  for (int i = 0; i < taps; i++) {
    ivec2 step = ivec2(i % 3, i / 3) - 1, at = clamp(texel + step, ivec2(0), size - 1);
    int away = step.x * step.x + step.y * step.y;
    if (away < nearest && texelFetch(seen_depth, ivec2(at.x, ROWS * at.y), 0).r < 1.0 && texelFetch(shaded, at, 0).w > 0.0) {
      nearest = away;
      found = at;
    }
  }
  return found;
}

// Sums over a sample's surroundings. coverage: covered, and not by nearer layers. first: the share for which this
// surface provides depth and normal. is_hit: whether the texel sees such a surface; is_behind: whether it is in a
// nearer layer. surface: normal and depth of the first.
struct Resolved {
  vec4 color;
  float coverage;
  float first;
  bool is_hit;
  bool is_behind;
  vec4 surface;
  Outputs outputs;
};

// The surface of the sample being resolved: if it is shaded, its colour and normal, fold 1 if a crease is beside it,
// and the range of stored depths that belong to it, empty if there are none, and their slope.
struct Own {
  ivec2 texel;
  ivec2 shaded_at;
  vec4 color;
  vec3 normal;
  int folds;
  vec2 range;
  vec2 slope;
};

// One position that the filter reaches.
struct Seen {
  float stored;  // depth at `at`, or at a neighbour that sees the same surface
  float level;  // the same, less what the own surface's slope explains
  ivec2 at;
  vec4 there;      // what is shaded at `at`
  bool is_smooth;  // no crease between this and `at`
  bool is_self;
  float shown;  // weight according to the nearer layers
  bool is_first;  // whether it provides depth and normal
  bool is_cut;
  vec4 here;       // its colour
  vec4 background;
};

#parts
void add_seen(inout Resolved sum, Own own, float seen, ivec2 at, vec4 there, bool is_smooth, bool is_between,
              vec2 away, float weight, vec4 background) {
  Seen s = Seen(seen, seen - dot(own.slope, away), at, there, is_smooth, at == own.texel && !is_between, weight,
                true, false, background, background);
  #hook count(sum, s)
  #hook cut(s)
  if (seen < 1.0 && !s.is_cut) {
    #hook show(sum, s, own)
    sum.coverage += s.shown;
    sum.first += s.is_first ? weight : 0.0;
    sum.is_hit = sum.is_hit || (s.is_self && s.is_first);
  }
  sum.color += s.shown * s.here;
}

Resolved resolve_sample(ivec2 texel) {
  ivec2 size = textureSize(shaded, 0);
  vec2 reached = reached_range(texel, size);
  Own own = Own(texel, shaded_at(texel, size), vec4(0.0), vec3(0.0), 0, vec2(2.0, -1.0), vec2(0.0));
  own.color = texelFetch(shaded, own.shaded_at, 0);
  vec4 seen_surface = texelFetch(surface, own.shaded_at, 0);
  seen_surface.w = abs(seen_surface.w);
  own.normal = seen_surface.xyz;
  bool is_there = own.color.w > 0.0, is_inside = false;
  if (is_there && reached.x < 1.0) {
    SameSurface same = same_surface(own.shaded_at, size, own.normal, seen_surface.w);
    is_inside = !same.is_folded && same.is_even && reached.y < 1.0 && is_all(same, reached);
    own.folds = same.is_folded ? 1 : 0;
    own.range = stored_range(same);
    own.slope = stored_slope(same);
  }
  vec4 background = vec4(0.0);
  #hook background(background, texel)
  Resolved sum = Resolved(vec4(0.0), 0.0, 0.0, false, false, seen_surface, NO_OUTPUTS);
  // Inside a surface and outside of all surfaces nothing needs filtering, so the loops run zero times.
  bool is_beside = reached.x == 1.0;
  #hook everywhere(is_inside, is_beside)
  bool is_even = is_inside || is_beside;
  float total = is_even ? 1.0 : 0.0;
  if (is_even) {
    sum = Resolved(is_inside ? own.color : background, 0.0, 0.0, is_inside, false, seen_surface, NO_OUTPUTS);
    if (is_inside) {
      sum.coverage = sum.first = 1.0;
      sum.outputs = sample_outputs(texel);
    }
  }
  // The Gaussian by forward differences: first value, first ratio of neighbours, and change of the ratio.
  float first_weight = exp(-0.5 * float(FILTER_REACH * FILTER_REACH) / view.filter_variance);
  float first_ratio = exp((float(FILTER_REACH) - 0.5 * STEP) * STEP / view.filter_variance);
  float ratio_ratio = exp(-STEP * STEP / view.filter_variance);
  int columns = is_even ? 0 : 2 * COLUMN_REACH + 1;
  for (int x = 0; x < columns; x++) {
    float weight = first_weight * (x == COLUMN_REACH ? 1.0 : column_ratio()), ratio = first_ratio, below = 1.0;
    ivec2 before = texel;
    vec4 shaded_before = vec4(0.0);
    bool is_smooth_before = true;
    for (int y = 0; y < 2 * FILTER_REACH + 1; y++) {
      ivec2 at = clamp(texel + ivec2(x - COLUMN_REACH, y - FILTER_REACH), ivec2(0), size - 1);
      vec2 away = vec2(texel - own.shaded_at + ivec2(x - COLUMN_REACH, y - FILTER_REACH));
      float seen = texelFetch(seen_depth, ivec2(at.x, ROWS * at.y), 0).r;
      vec4 there = texelFetch(shaded, at, 0);
      bool is_smooth = true;
      for (int turn = 0; turn < own.folds; turn++) is_smooth = dot(texelFetch(surface, at, 0).xyz, own.normal) >= SMOOTH;
      if (ROWS > 1 && y > 0) {
        // Between two samples, the surface of either is visible; if both are, rounding must not decide.
        float between = texelFetch(seen_depth, ivec2(at.x, max(ROWS * at.y - 1, 0)), 0).r;
        bool is_before = abs(between - below) < 0.5 * abs(between - seen);
        add_seen(sum, own, between, is_before ? before : at, is_before ? shaded_before : there,
                 is_before ? is_smooth_before : is_smooth, true, away - vec2(0.0, STEP), weight,
                 background);
        total += weight;
        weight *= ratio;
        ratio *= ratio_ratio;
      }
      add_seen(sum, own, seen, at, there, is_smooth, false, away, weight, background);
      total += weight;
      weight *= ratio;
      ratio *= ratio_ratio;
      below = seen;
      before = at;
      shaded_before = there;
      is_smooth_before = is_smooth;
    }
  }
  sum.color /= total;
  sum.coverage /= total;
  sum.first /= total;
  sum.outputs = added(NO_OUTPUTS, sum.outputs, 1.0 / total);
  return sum;
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
      Resolved here = resolve_sample(texel);
      color_total += here.color;
      outputs_total = added(outputs_total, here.outputs, 1.0);
      is_seen_nearer = is_seen_nearer || here.is_behind;
      normal_total += vec4(here.surface.xyz * here.first, here.coverage);
      if (here.is_hit && here.surface.w > 0.0) nearest = min(nearest, here.surface.w * view.world_length);
    }
  }
  float share = 1.0 / float(SAMPLES * SAMPLES);
  #hook pixel(color_total, normal_total, nearest, is_seen_nearer, outputs_total, share)
}
