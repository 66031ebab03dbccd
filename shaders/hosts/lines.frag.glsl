// References: Saito and Takahashi, "Comprehensible Rendering of 3-D Shapes", SIGGRAPH 1990 (lines from discontinuities of
//             depth and normal in the picture).
// Summary: the share of a sample that a line covers. Eight walks start from it over its own surface. Where one reaches
//          the background or a drop in depth, there is a silhouette; where the normal changes between two opposite
//          walks, and most of that within a few pixels, there is a crease, in the middle of the change. Hooks: `see`,
//          whether a surface is visible; `widen`, how wide its line is; `meet`, what it meets; `cover`, what other lines
//          cover.

#include "hosts/mean_surface.glsl"

const float EMPTY = 3e38;
const float OUTSIDE = -3e38;
const float TURN_REACH = CREASE_REACH * float(SAMPLES);
const float LEAST_FACING = 0.1;  // minimum cosine to the viewer when estimating a surface's slope
const int RIM = SAMPLES;
const float SLOPE_ROOM = 1.5;
// On a uniform bend, this share of the walks around the middle has the same share of the turn; on a crease it has all
// of it.
const float LARGEST_SHARE = 0.7;

#parts
// Normal and depth; EMPTY for no surface, OUTSIDE beyond the drawn area.
vec4 sight_at(ivec2 texel) {
  ivec2 size = SIZE_OF(gbuffer_color);
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return vec4(0.0, 0.0, 0.0, OUTSIDE);
  MeanSurface mean = mean_surface(texel, 0);
  bool is_seen = mean.coverage > 0.0;
  #hook see(texel, is_seen)
  if (!is_seen) return vec4(0.0, 0.0, 0.0, EMPTY);
  float size_of_normal = length(mean.normal);
  return vec4(size_of_normal > 0.0 ? mean.normal / size_of_normal : vec3(0.0, 0.0, 1.0), mean.depth);
}

// Change of the depth of the sample's plane over this many samples.
float slope(vec4 sight, ivec2 texel, ivec2 along) {
  vec2 moved = vec2(along) * view.window.zw;
  bool is_parallel = view.is_parallel > 0.5;
  vec3 ray = is_parallel ? vec3(0.0, 0.0, -1.0)
                         : vec3(view.window.xy + (vec2(texel + along) + 0.5) * view.window.zw, -1.0);
  float facing = max(abs(dot(sight.xyz, ray)), LEAST_FACING * length(ray));
  return abs(dot(sight.xy, moved)) / facing * (is_parallel ? 1.0 : sight.w);
}

struct Walk {
  int steps;  // number of steps to the last sample of the same surface before its rim
  float drop;  // distance in samples to the edge beyond which it is deeper
  vec3 normal;  // of the last sample
};

Walk walk(ivec2 texel, vec4 start, ivec2 along, float reach) {
  float stride = length(vec2(along));
  Walk result = Walk(0, 1e9, start.xyz);
  vec4 here = start;
  int farthest = int(ceil(reach / stride));
  for (int k = 1; k <= farthest; k++) {
    ivec2 at = texel + k * along;
    vec4 next = sight_at(at);
    if (next.w == OUTSIDE) break;
    bool is_edge = next.w == EMPTY;
    if (!is_edge) {
      float pixel = view.window.z * float(SAMPLES) * (view.is_parallel > 0.5 ? 1.0 : here.w);
      float room = SLOPE_ROOM * max(slope(here, at - along, along), slope(next, at, -along));
      is_edge = abs(next.w - here.w) > room + frame.line_drop * pixel;
    }
    if (is_edge) {
      if (next.w > here.w) result.drop = (float(k) - 0.5) * stride;
      // At the rim, protruding splats are visible whose surface may face another way.
      result.steps = max(result.steps - RIM, 0);
      result.normal = sight_at(texel + result.steps * along).xyz;
      break;
    }
    #hook meet(at, (float(k) - 0.5) * stride)
    result.steps = k;
    result.normal = next.xyz;
    here = next;
  }
  return result;
}

float turned(ivec2 texel, vec3 turn) {
  return dot(sight_at(texel).xyz, turn);
}

// Distance in samples to a crease between the walks ahead and back, 1e9 if there is none within reach.
float crease_distance(ivec2 texel, vec3 normal, ivec2 along, Walk ahead, Walk back, float reach) {
  if (dot(ahead.normal, back.normal) >= frame.line_crease) return 1e9;
  vec3 turn = ahead.normal - back.normal;
  float middle = 0.5 * (dot(ahead.normal, turn) + dot(back.normal, turn));
  float before = dot(normal, turn) - middle;
  // The middle of the turn is ahead if this sample has turned by less than half.
  ivec2 step_to = before < 0.0 ? along : -along;
  int farthest = before < 0.0 ? ahead.steps : back.steps;
  float stride = length(vec2(along)), at = 1e9;
  int limit = min(farthest, int(ceil(reach / stride)));
  int found = 0;
  if (before == 0.0) at = 0.0;
  for (int k = 1; k <= limit && at == 1e9; k++) {
    float after = turned(texel + k * step_to, turn) - middle;
    if (before * after <= 0.0) {
      at = float(k - 1) + before / (before - after);
      found = k;
    }
    before = after;
  }
  if (at == 1e9) return at;
  int center = int(floor(at + 0.5)) * (step_to == along ? 1 : -1);
  int all_steps = ahead.steps + back.steps, near = max(all_steps / 4, 1);
  float share = min(2.0 * float(near) / float(all_steps), 1.0);
  float most = turned(texel + along * min(center + near, ahead.steps), turn)
             - turned(texel + along * max(center - near, -back.steps), turn);
  return share < LARGEST_SHARE && most >= mix(share, 1.0, 0.5) * dot(turn, turn) ? at * stride : 1e9;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 own = sight_at(texel);
  lines = 0.0;
  if (own.w == EMPTY) {
    lines = mean_surface(texel, 0).coverage > 0.0 ? 1.0 : 0.0;
    return;
  }
  float width = frame.line_width;
  #hook widen(texel, width)
  float beside = 0.5 * width + float(SAMPLES);
  float reach = 2.0 * beside + TURN_REACH;
  float silhouette = 1e9, crease = 1e9;
  ivec2 ways[4] = ivec2[4](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));
  for (int i = 0; i < 4; i++) {
    Walk ahead = walk(texel, own, ways[i], reach), back = walk(texel, own, -ways[i], reach);
    silhouette = min(silhouette, min(ahead.drop, back.drop));
    crease = min(crease, crease_distance(texel, own.xyz, ways[i], ahead, back, beside));
  }
  lines = max(clamp(width - silhouette + 0.5, 0.0, 1.0), clamp(0.5 * width - crease + 0.5, 0.0, 1.0));
  #hook cover(own, texel, lines)
}
