// References: Jimenez, Wu, Pesce, Jarabo, "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016 (horizons
//             in slices, the inner integral, light that is reflected more than once);
//             Lagarde, de Rousiers, "Moving Frostbite to PBR", 2014, section 4.10.2 (reflections).
// Summary: the share of the world's light that other visible surfaces leave to a sample. Taps are whole samples beside
//          the slice: each is moved into it along the surface, so that a plane has its own horizon. Slices and taps of
//          4 x 4 samples differ, and so do those of a picture's samples; their mean over the same surface is the share.
//          The twin of reference/ambient_occlusion.py.

#part world_light
float open_share = 1.0;  // of the half-space around the normal, cosine-weighted
float open_cosine = 1.0;  // cosine between the normal and the viewer
vec3 open_diffuse = vec3(1.0);  // incoming light, including what occluders reflect

void ambient_occlusion_diffuse(inout vec3 light) {
  light *= open_diffuse;
}

void ambient_occlusion_behind(inout vec3 light) {
  light *= open_diffuse;
}

void ambient_occlusion_reflected(inout vec3 light, vec3 direction, float roughness) {
  float power = exp2(-16.0 * roughness - 1.0);
  light *= clamp(pow(open_cosine + open_share, power) - 1.0 + open_share, 0.0, 1.0);
}

#part occlusion.frag
#include "lib/to_viewer.glsl"

const float HALF_TURN = 3.14159265358979;
const int OCCLUSION_SLICES = 2;
// Minimum cosine to the viewer: a mean normal may face away although the surface is visible.
const float LEAST_OCCLUSION_FACING = 0.2;
const int OCCLUSION_STEPS = 8;

struct Slice {
  vec2 along;   // in samples, unit
  vec3 off;     // unit, perpendicular to the slice
  vec3 beside;  // from a tap beside the slice into it, along the surface, per distance
};

struct Search {
  float distance;
  float reach;  // the same in samples
  float phase;  // of the steps, which grow with the distance
};

// Cosine between the direction to the viewer and the highest horizon along a direction, at least `lowest`. Occluders
// beyond half the distance fade out.
float horizon_cosine(ivec2 texel, vec3 position, vec3 to_eye, Slice slice, Search search, float lowest) {
  ivec2 low = ivec2(frame.occlusion_picture.xy), high = ivec2(frame.occlusion_picture.zw);
  // to the picture's edge along the slice: where a tap leaves the picture, the next row has one less, which shows
  vec2 room = mix(vec2(texel - low), vec2(high - texel), step(vec2(0.0), slice.along));
  room /= max(abs(slice.along), vec2(1e-6));
  float reach = min(search.reach, min(room.x, room.y));
  float highest = lowest, per_distance = 2.0 / search.distance;
  int last = 0;
  for (int i = 0; i < OCCLUSION_STEPS; i++) {
    float share = (float(i) + search.phase) / float(OCCLUSION_STEPS);
    last = max(last + 1, int(share * share * reach + 0.5));
    ivec2 at = texel + ivec2(floor(slice.along * float(last) + 0.5));
    if (at != clamp(at, low, high)) break;
    float depth = texelFetch(sample_depths, at, 0).r;
    if (!(depth > 0.0)) continue;
    vec3 toward = eye_position(at, depth) - position;
    toward -= slice.beside * dot(toward, slice.off);
    float square = max(dot(toward, toward), 1e-30), per_length = inversesqrt(square);
    float weight = clamp(2.0 - square * per_length * per_distance, 0.0, 1.0);
    highest = max(highest, mix(lowest, dot(toward, to_eye) * per_length, weight));
  }
  return min(highest, 1.0);
}

// Integral of the cosine to the normal times the sine, over an angle from the viewer given by its cosine, on the side
// where `normal.y` points: equation 7 times the normal's length, where half of 1 - cos 2a is 1 - cosine^2.
float arc(float cosine, vec2 normal) {
  float square = 1.0 - cosine * cosine, sine = sqrt(square);
  return 0.5 * (normal.x * square + normal.y * (atan(sine, cosine) - cosine * sine));  // acos differs by the driver
}

float open_share_at(ivec2 texel, vec3 position, vec3 normal) {
  vec3 to_eye = to_viewer(position);
  bool is_parallel = view.is_parallel > 0.5;
  float per_sample = view.window.z * (is_parallel ? 1.0 : -position.z), distance = frame.occlusion_distance;
  // whatever the scene's scale, and things that are far in front leave no dark rim on what is behind them
  if (!(distance > 0.0)) distance = OCCLUSION_SHARE * (is_parallel ? per_sample * frame.occlusion_height : -position.z);
  float reach = min(distance / per_sample, frame.occlusion_reach);
  if (!(reach > 1.0)) return 1.0;
  // Of 16 angles each sample of a block has one, far from its neighbours'; and one of four phases.
  ivec2 cell = (texel + ivec2(frame.occlusion_shift)) & 3;
  int number = (cell.x * 4 + ((cell.y + cell.x * 2) & 3) * 5) & 15;
  float turn = (float(number) + frame.occlusion_turn) / 16.0;
  float phase = 0.25 + 0.1875 * (float((cell.y + 2 * (cell.x & 1) + (cell.x >> 1)) & 3) + frame.occlusion_turn);
  Search search = Search(distance, reach, phase);
  float open = 0.0, all = 0.0;
  for (int i = 0; i < OCCLUSION_SLICES; i++) {
    float angle = HALF_TURN * (float(i) + turn) / float(OCCLUSION_SLICES);
    vec2 along = vec2(cos(angle), sin(angle));
    vec3 across = vec3(along, 0.0);
    across = normalize(across - to_eye * dot(across, to_eye));
    Slice slice = Slice(along, cross(to_eye, across), vec3(0.0));
    float tilt = dot(normal, slice.off);
    slice.beside = (slice.off - normal * tilt) / max(1.0 - tilt * tilt, LEAST_OCCLUSION_FACING);
    vec2 own = vec2(max(dot(normal, to_eye), LEAST_OCCLUSION_FACING), dot(normal, across));  // the normal in the slice
    float lowest = own.y / length(own);
    open += arc(horizon_cosine(texel, position, to_eye, slice, search, -lowest), own);
    slice.along = -along;
    open += arc(horizon_cosine(texel, position, to_eye, slice, search, lowest), vec2(own.x, -own.y));
    all += own.x + atan(own.y, own.x) * own.y;
  }
  return clamp(open / all, 0.0, 1.0);
}

void ambient_occlusion_occlude(inout vec2 open_depth, MeanSurface mean, ivec2 texel) {
  vec3 normal = normalize(mean.normal);
  open_depth = vec2(open_share_at(texel, eye_position(texel, mean.depth), normal), mean.depth);
}

#part shaded_sample
#include "lib/to_viewer.glsl"

// Samples beside the surface's plane by this many of their widths count for nothing.
const float OCCLUSION_PLANE = 2.0;
const float LEAST_OCCLUSION_WEIGHT = 1e-3;

// The mean of 4 x 4 samples around one, those in its plane.
float open_share_around(ivec2 texel, vec3 position, vec3 normal) {
  float per_sample = view.window.z * (view.is_parallel > 0.5 ? 1.0 : -position.z);
  float per_offset = 1.0 / (OCCLUSION_PLANE * per_sample);
  ivec2 low = ivec2(frame.occlusion_picture.xy), high = ivec2(frame.occlusion_picture.zw);
  vec2 total = vec2(0.0);
  for (int y = -2; y < 2; y++) {
    for (int x = -2; x < 2; x++) {
      ivec2 at = clamp(texel + ivec2(x, y), low, high);
      vec2 open_depth = texelFetch(occlusion, at, 0).xy;
      if (!(open_depth.y > 0.0)) continue;
      float offset = abs(dot(normal, eye_position(at, open_depth.y) - position));
      total += vec2(open_depth.x, 1.0) * max(1.0 - offset * per_offset, LEAST_OCCLUSION_WEIGHT);
    }
  }
  return total.y > 0.0 ? total.x / total.y : 1.0;
}

void leave_open(float share, vec3 color) {
  open_share = share;
  vec3 albedo = clamp(color, 0.0, 1.0);
  vec3 a = 2.0404 * albedo - 0.3324, b = 0.6417 - 4.7951 * albedo, c = 2.7552 * albedo + 0.6903;
  open_diffuse = max(vec3(share), ((a * share + b) * share + c) * share);
}

void ambient_occlusion_prepare(inout Shaded s) {
  vec3 position = eye_position(s.texel, s.mean.depth);
  open_cosine = clamp(dot(s.normal, to_viewer(position)), 0.0, 1.0);
  leave_open(open_share_around(s.texel, position, s.normal), s.mean.color);
}
