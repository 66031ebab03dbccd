// References: McGuire, Mara, "Efficient GPU Screen-Space Ray Tracing", JCGT 2014; Szirmay-Kalos, Aszodi, Lazanyi, Premecz, "Approximate Ray-Tracing on the GPU with Distance Impostors", 2005
//             (a ray among the distances that a probe sees); Lagarde, Zanuttini, "Local Image-based Lighting With
//             Parallax-corrected Cubemaps", 2012 (the place of what is seen, boxes that use a probe; a lobe is narrower
//             for what is near the surface); Karis, "Real Shading in Unreal Engine 4", 2013 (blurred pictures).
// Summary: what a surface in a probe's box reflects: what the probe sees where the reflected ray meets it, and the
//          world beside that. The texture is that of rendering/probes/pictures.py. The twin of reference/reflections.py.

#part world_light
float reflecting = 0.0;  // share of a probe in what this surface reflects
vec3 reflecting_place;  // from the probe's middle
ivec2 reflecting_texels;  // where its pictures begin

ivec2 probe_map_origin(int number) {
  int side = int(frame.probe_side);
  ivec2 origin = reflecting_texels;
  if (number > 0) origin.x += side + 2;
  if (number > 1) origin.y += side / 2 + 2;
  for (int k = 2; k < number; k++) origin.x += (side >> k) + 2;
  return origin;
}

// Interpolated in one of its maps, which begins at a texel and has a border.
vec4 probe_map_at(ivec2 origin, int side, vec3 direction) {
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = vec2(d.x >= 0.0 ? 1.0 - abs(d.y) : abs(d.y) - 1.0, d.y >= 0.0 ? 1.0 - abs(d.x) : abs(d.x) - 1.0);
  vec2 at = ((d.z < 0.0 ? folded : d.xy) * 0.5 + 0.5) * float(side) + 0.5;
  ivec2 low = clamp(ivec2(floor(at)), ivec2(0), ivec2(side));
  vec2 share = at - vec2(low);
  ivec2 first = origin + low;
  vec4 below = mix(texelFetch(probes, first, 0), texelFetch(probes, first + ivec2(1, 0), 0), share.x);
  vec4 above = mix(texelFetch(probes, first + ivec2(0, 1), 0), texelFetch(probes, first + ivec2(1, 1), 0), share.x);
  return mix(below, above, share.y);
}

// The same in the sharp map, whose texels have the inverse of a distance in the place of their opacity.
vec4 probe_sharp_at(vec3 direction) {
  int side = int(frame.probe_side);
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = vec2(d.x >= 0.0 ? 1.0 - abs(d.y) : abs(d.y) - 1.0, d.y >= 0.0 ? 1.0 - abs(d.x) : abs(d.x) - 1.0);
  vec2 at = ((d.z < 0.0 ? folded : d.xy) * 0.5 + 0.5) * float(side) + 0.5;
  ivec2 low = clamp(ivec2(floor(at)), ivec2(0), ivec2(side));
  vec2 share = at - vec2(low);
  vec4 total = vec4(0.0);
  for (int k = 0; k < 4; k++) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    vec2 near = mix(1.0 - share, share, vec2(corner));
    vec4 texel = texelFetch(probes, reflecting_texels + low + corner, 0);
    total += vec4(texel.rgb, texel.a > 0.0 ? 1.0 : 0.0) * (near.x * near.y);
  }
  return total;
}

float probe_inverse_distance(vec3 direction) {
  return probe_map_at(reflecting_texels, int(frame.probe_side), direction).a;
}

const int PROBE_STEPS = 16;
const int PROBE_HALVINGS = 3;
// Behind what begins to hide it by more than this share of the inverse distance, a ray does not meet it.
const float PROBE_BEHIND = 0.05;

// A ray from the surface, seen from the probe. Its points are given by the cosine and sine of the angle from its start.
struct ProbeRay {
  vec3 from;
  vec3 side;
  float inverse;    // of the distance of its start
  float cotangent;  // of the angle of its end
};

vec3 probe_toward(ProbeRay ray, vec2 turned) {
  return ray.from * turned.x + ray.side * turned.y;
}

// The inverse distance of the ray's point.
float probe_own(ProbeRay ray, vec2 turned) {
  return ray.inverse * max(turned.x - turned.y * ray.cotangent, 0.0);
}

// How much nearer than the ray's point the probe sees something, as inverse distances.
float probe_nearer(ProbeRay ray, vec2 turned) {
  return probe_inverse_distance(probe_toward(ray, turned)) - probe_own(ray, turned);
}

// A bit more than the angle that a texel spans.
float probe_texel(vec3 toward) {
  vec3 size = abs(toward);
  return 3.0 / frame.probe_side * pow(size.x + size.y + size.z, 1.5);
}

// Whether the ray does not meet what begins to hide it, but passes behind its rim: distances are interpolated there, and
// those of what hides it go on towards the rim as a plane's. beside: the direction of what is seen beside the rim.
bool probe_passes_behind(ProbeRay ray, vec2 turned, out vec3 beside) {
  vec3 toward = probe_toward(ray, turned);
  float texel = probe_texel(toward);
  vec3 along = texel * (ray.side * turned.x - ray.from * turned.y), across = texel * cross(ray.from, ray.side);
  vec3 rise = along * (probe_inverse_distance(toward + along) - probe_inverse_distance(toward - along))
      + across * (probe_inverse_distance(toward + across) - probe_inverse_distance(toward - across));
  rise /= ray.inverse;
  vec3 nearer = rise * (texel / max(length(rise), 1e-9));
  float near = probe_inverse_distance(toward + nearer);
  float rim = min(near, 2.0 * near - probe_inverse_distance(toward + 2.0 * nearer));
  beside = toward - nearer;
  return rim - probe_own(ray, turned) > PROBE_BEHIND * rim;
}

// Where between two of its points the ray meets what is nearer than the second.
vec2 probe_met(ProbeRay ray, vec2 low, vec2 high, float at_low, float at_high) {
  for (int k = 0; k < PROBE_HALVINGS; k++) {
    vec2 middle = normalize(low + high);
    float at = probe_nearer(ray, middle);
    if (at < 0.0) { low = middle; at_low = at; } else { high = middle; at_high = at; }
  }
  return normalize(mix(low, high, at_low / (at_low - at_high)));
}

// The direction from the probe in which a ray from the surface meets what the probe sees. away: how far that is from
// the surface over how far it is from the probe. Steps are even in the angle that the ray's points have at the probe.
// What is hidden behind something is taken to be as what is seen beside that.
vec3 probe_direction(vec3 direction, out float away) {
  float inverse = inversesqrt(max(dot(reflecting_place, reflecting_place), 1e-30));
  vec3 from = reflecting_place * inverse;
  float cosine = dot(from, direction);
  vec3 side = direction - from * cosine;
  float sine = length(side);
  away = 1.0;
  if (sine < 1e-3) return direction;
  ProbeRay ray = ProbeRay(from, side / sine, inverse, cosine / sine);
  float angle = atan(sine, cosine) / float(PROBE_STEPS);
  mat2 turn = mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
  vec2 last = vec2(1.0, 0.0), next;
  float before = probe_nearer(ray, last), after;
  vec3 found = direction, beside;
  bool passed = false;
  // one loop finds what hides the ray and the outer one decides, because some drivers run all that is in a loop each time
  for (int i = 0; i < PROBE_STEPS; i++) {
    for (; i < PROBE_STEPS; i++) {
      next = turn * last;
      after = probe_nearer(ray, next);
      if (before < 0.0 && after > 0.0) break;
      last = next;
      before = after;
    }
    if (i == PROBE_STEPS) break;
    vec2 met = probe_met(ray, last, next, before, after);
    bool passes = probe_passes_behind(ray, met, beside);
    if (!passes || !passed) {
      found = passes ? beside : probe_toward(ray, met);
      away = met.y / sine;
    }
    if (!passes) break;
    passed = true;
    last = next;
    before = after;
  }
  return found;
}

const int PROBE_LEVELS = 4;
const float PROBE_ROUGHNESS[4] = float[4](0.4, 0.6, 0.8, 1.0);
const int PROBE_LEVEL_SIDE = 32;
// Blurred maps give way to levels from this roughness on.
const float PROBE_MAPS_END = 0.3;
// A texel of the map that is looked up, over the lobe's half width: the square of the roughness.
const float PROBE_TEXEL = 2.4;

vec4 probe_level_at(int level, vec3 direction) {
  ivec2 origin = reflecting_texels + ivec2(level * (PROBE_LEVEL_SIDE + 2), int(frame.probe_side) + 2);
  return probe_map_at(origin, PROBE_LEVEL_SIDE, direction);
}

vec4 probe_blurred_at(vec3 direction, float roughness) {
  int level = 0;
  while (level < PROBE_LEVELS - 2 && roughness > PROBE_ROUGHNESS[level + 1]) level++;
  float share = (roughness - PROBE_ROUGHNESS[level]) / (PROBE_ROUGHNESS[level + 1] - PROBE_ROUGHNESS[level]);
  vec4 finer = probe_level_at(level, direction);
  return share > 0.0 ? mix(finer, probe_level_at(level + 1, direction), min(share, 1.0)) : finer;
}

vec4 probe_mapped_at(vec3 direction, float roughness) {
  // a texel of a map of side n is 3.5 / n wide
  float texels = PROBE_TEXEL * roughness * roughness * frame.probe_side / 3.5449077;
  float number = clamp(log2(max(texels, 1.0)), 0.0, float(PROBE_MAPS - 1));
  int low = int(number);
  vec4 finer = low == 0 ? probe_sharp_at(direction)
      : probe_map_at(probe_map_origin(low), int(frame.probe_side) >> low, direction);
  if (number == float(low)) return finer;
  vec4 coarser = probe_map_at(probe_map_origin(low + 1), int(frame.probe_side) >> (low + 1), direction);
  return mix(finer, coarser, number - float(low));
}

// What a probe shows of what a lobe meets; its opacity. direction: in the view.
vec4 probe_lobe(vec3 direction, float roughness) {
  float away;
  vec3 toward = probe_direction(normalize(mat3(frame.to_probes) * direction), away);
  float rough = min(roughness * sqrt(max(away, 0.0)), 1.0);
  float share = clamp((rough - PROBE_MAPS_END) / (PROBE_ROUGHNESS[0] - PROBE_MAPS_END), 0.0, 1.0);
  vec4 seen = vec4(0.0);
  if (share < 1.0) seen += (1.0 - share) * probe_mapped_at(toward, rough);
  if (share > 0.0) seen += share * probe_blurred_at(toward, rough);
  return seen;
}

void reflections_through(inout vec3 light, vec3 place, vec3 direction, float roughness) {
  if (!(reflecting > 0.0)) return;
  vec3 own = reflecting_place;
  reflecting_place += mat3(frame.to_probes) * place;
  vec4 seen = probe_lobe(direction, roughness);
  light = mix(light, seen.rgb + (1.0 - seen.a) * sent_reflection(direction, roughness), reflecting);
  reflecting_place = own;
}

#part world_light, off_screen
void off_screen_reflected(inout vec3 light, vec3 direction, float roughness) {
  if (!(reflecting > 0.0)) return;
  vec4 seen = probe_lobe(direction, roughness);
  light = mix(light, seen.rgb + (1.0 - seen.a) * sent_reflection(direction, roughness), reflecting);
}

#part world_light, on_screen
#include "lib/lobe_rays.glsl"
#include "lib/picture_march.glsl"
#include "lib/to_viewer.glsl"

vec3 reflecting_from;  // view space
vec3 reflecting_normal;
int reflecting_number;  // of the pixel's samples

// Beside the picture's edge, in shares of it, what it shows gives way to what probes show.
const float SCREEN_FADES = 0.08;
// From this width on, radians, up to twice it, a lobe's mean is the probe's, which is blurred over all that is around.
const float SCREEN_WIDEST = 0.15;

// What the camera sees of what a ray meets, and its opacity; share: 0 where it meets nothing there.
vec4 screen_met(vec3 along, float width, out float share) {
  vec3 found, first = in_picture(reflecting_from);
  bool is_open;
  share = 0.0;
  if (width >= 2.0 * SCREEN_WIDEST) return vec4(0.0);
  if (any(lessThan(first.xy, vec2(0.0))) || any(greaterThan(first.xy, frame.screen_size))) return vec4(0.0);
  if (!met_in_picture(picture_way(reflecting_from, along, FAR), found, is_open)) return vec4(0.0);
  float depth = view.is_parallel > 0.5 ? 1.0 : found.z;
  vec3 place = vec3((found.xy / frame.screen_window.zw + frame.screen_window.xy) * depth, -found.z);
  vec2 beside = min(found.xy, frame.screen_size - found.xy) / frame.screen_size;
  share = clamp(min(beside.x, beside.y) / SCREEN_FADES, 0.0, 1.0) * clamp(2.0 - width / SCREEN_WIDEST, 0.0, 1.0);
  return picture_mapped_at(found.xy, width * distance(place, reflecting_from) / depth * frame.screen_window.w);
}

void on_screen_reflected(inout vec3 light, vec3 direction, float roughness) {
  if (!(reflecting > 0.0)) return;
  LobeRay ray = lobe_ray(reflecting_normal, to_viewer(reflecting_from), direction, roughness, reflecting_number);
  float share, rough = min(sqrt(ray.width / PROBE_TEXEL), 1.0);
  vec4 seen = screen_met(ray.along, ray.width, share);
  if (share < 1.0) seen = mix(probe_lobe(ray.along, rough), seen, share);
  light = mix(light, seen.rgb + (1.0 - seen.a) * sent_reflection(ray.along, rough), reflecting);
}

#part shaded_sample, on_screen
void on_screen_prepare(inout Shaded s) {
  ivec2 within = s.texel % int(frame.reflected_sample.y);
  reflecting_from = eye_position(s.texel, s.mean.depth);
  reflecting_normal = s.normal;
  reflecting_number = int(frame.reflected_sample.x) + within.y * int(frame.reflected_sample.y) + within.x;
}

#part shaded_sample
// Surfaces that face away from its middle belong to a probe's box up to its rim, with room for rounding. Of others, such
// as a floor under what has the probe, it fades out between these shares of the half-axes, so that no rim shows.
const float PROBE_FADES = 0.7;
const float PROBE_INSIDE = 0.95;
const float PROBE_OUTSIDE = 1.01;

void reflections_prepare(inout Shaded s) {
  vec3 position = (frame.to_probes * vec4(eye_position(s.texel, s.mean.depth), 1.0)).xyz;
  vec3 normal = mat3(frame.to_probes) * s.normal;
  int side = int(frame.probe_side), count = int(frame.probe_count);
  reflecting = 0.0;
  for (int k = 0; k < count; k++) {
    vec3 at;
    for (int axis = 0; axis < 3; axis++) {
      vec4 row = texelFetch(probes, ivec2(PROBE_HEADER * k + axis, 0), 0);
      at[axis] = abs(dot(row.xyz, position) + row.w);
    }
    vec3 place = position - texelFetch(probes, ivec2(PROBE_HEADER * k + 3, 0), 0).xyz;
    float reach = max(max(at.x, at.y), at.z);
    reflecting = dot(normal, place) > 0.0 ? float(reach <= PROBE_OUTSIDE)
        : clamp((PROBE_INSIDE - reach) / (PROBE_INSIDE - PROBE_FADES), 0.0, 1.0);
    if (!(reflecting > 0.0)) continue;
    reflecting_place = place;
    reflecting_texels = ivec2(0, 1 + k * (side + PROBE_LEVEL_SIDE + 4));
    break;
  }
}
