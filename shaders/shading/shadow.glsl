// References: Williams, "Casting Curved Shadows on Curved Surfaces", 1978; Reeves, Salesin, Cook, "Rendering Antialiased
//             Shadows with Depth Maps", 1987 (compare, then filter); Fernando, "Percentage-Closer Soft Shadows", 2005.
// Summary: which share of a light reaches a place. Depths are compared with the plane of the surface that is lit, so
//          that a wide filter does not shadow it by itself; splats lie in the map one epsilon farther than they are.

const int SOFT_SAMPLES = 32;
// Neighbouring samples of the picture look at different places: a pixel of 2 x 2 samples has four times as many of them.
float shadow_turn;
// Of the plane that is lit, where its normal is not the one that is shaded; 0 elsewhere.
vec3 shadow_plane;
const float GOLDEN_ANGLE = 2.39996323;
const float GRAZING = 0.08;  // least cosine that a surface's plane is followed at

struct ShadowPlace {
  vec4 window;
  vec4 atlas;    // x, y, resolution, 1 for a parallel camera
  vec4 depths;   // stored to depth: factor, summand; size of a texel (at depth 1 of a perspective)
  vec3 position; // in the light's view
  vec3 normal;
  float depth;
  vec2 place;    // on the light's window
};

bool shadow_place(int map, vec3 position, vec3 normal, out ShadowPlace here) {
  mat3 turn = transpose(mat3(texelFetch(shadow_maps, ivec2(0, map), 0).xyz, texelFetch(shadow_maps, ivec2(1, map), 0).xyz,
                             texelFetch(shadow_maps, ivec2(2, map), 0).xyz));
  vec3 shift = vec3(texelFetch(shadow_maps, ivec2(0, map), 0).w, texelFetch(shadow_maps, ivec2(1, map), 0).w,
                    texelFetch(shadow_maps, ivec2(2, map), 0).w);
  here.window = texelFetch(shadow_maps, ivec2(3, map), 0);
  here.atlas = texelFetch(shadow_maps, ivec2(4, map), 0);
  here.depths = texelFetch(shadow_maps, ivec2(5, map), 0);
  here.position = turn * position + shift;
  here.normal = normalize(turn * normal);
  bool is_parallel = here.atlas.w > 0.5;
  here.depth = -here.position.z;
  if (!is_parallel && here.depth <= 0.0) return false;
  here.place = is_parallel ? here.position.xy : here.position.xy / here.depth;
  vec2 at = (here.place - here.window.xy) * here.window.zw;
  return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
}

// Depth of the lit surface's plane beside the place; near its horizon it is not followed.
float receiver_depth(ShadowPlace here, vec2 place) {
  if (here.atlas.w > 0.5) {
    float slope = max(abs(here.normal.z), GRAZING) * (here.normal.z < 0.0 ? -1.0 : 1.0);
    return here.depth + dot(here.normal.xy, place - here.place) / slope;
  }
  vec3 toward = vec3(place, -1.0);
  float facing = dot(here.normal, toward), own = dot(here.normal, here.position);
  float least = GRAZING * length(toward);
  return abs(facing) > least ? clamp(own / facing, 0.5 * here.depth, 2.0 * here.depth) : here.depth;
}

#ifdef SCREEN_DOOR
#include "common/masked_looks.glsl"
#else
// A tent of two texels around the place.
const int FILTER_TEXELS = 4;
vec2 hard_filter(vec2 distance) {
  return max(2.0 - abs(distance), 0.0);
}

const int SEARCH_LOOKS = SOFT_SAMPLES, FILTER_LOOKS = SOFT_SAMPLES;

// Radius and angle in the unit disc.
vec2 soft_look(int number, int count) {
  float at = float(number) + shadow_turn;
  return vec2(sqrt(at / float(count)), at * GOLDEN_ANGLE);
}

ivec2 soft_texel(vec2 at, int number) {
  return ivec2(floor(at));
}

// The nearest of the map's texels, size by size.
ivec2 inside_map(ivec2 texel, int size) {
  return clamp(texel, ivec2(0), ivec2(size - 1));
}
#endif

float blocker_depth(ShadowPlace here, ivec2 texel) {
  float stored = texelFetch(shadow_depth, inside_map(texel, int(here.atlas.z)) + ivec2(here.atlas.xy), 0).r;
  return stored < 1.0 ? here.depths.x * stored + here.depths.y : 3.4e38;
}

vec2 texel_place(ShadowPlace here, ivec2 texel) {
  return here.window.xy + (vec2(texel) + 0.5) / (here.window.zw * here.atlas.z);
}

float hard_share(ShadowPlace here, float bias) {
  vec2 at = (here.place - here.window.xy) * here.window.zw * here.atlas.z - 0.5;
  ivec2 low = ivec2(floor(at)) - (FILTER_TEXELS / 2 - 1);
  float lit = 0.0, total = 0.0;
  for (int y = 0; y < FILTER_TEXELS; y++) {
    for (int x = 0; x < FILTER_TEXELS; x++) {
      ivec2 texel = low + ivec2(x, y);
      vec2 tent = hard_filter(vec2(texel) - at);
      float weight = tent.x * tent.y;
      lit += blocker_depth(here, texel) + bias >= receiver_depth(here, texel_place(here, texel)) ? weight : 0.0;
      total += weight;
    }
  }
  return lit / total;
}

// Of a look into the map, by its number of so many around the place.
ivec2 texel_of_look(ShadowPlace here, int number, int count, float reach) {
  vec2 look = soft_look(number, count);
  vec2 place = here.place + look.x * reach * vec2(cos(look.y), sin(look.y));
  return soft_texel((place - here.window.xy) * here.window.zw * here.atlas.z, number);
}

// size: of the lamp, half its width; of a sun the tangent of half its angle.
float soft_share(ShadowPlace here, float bias, float size) {
  bool is_parallel = here.atlas.w > 0.5;
  float reach = is_parallel ? size * max(here.depth - here.depths.y, 0.0) : 3.0 * size / here.depth;
  reach = min(reach, 0.25 / max(here.window.z, here.window.w));
  float blockers = 0.0, sum = 0.0;
  for (int i = 0; i < SEARCH_LOOKS; i++) {
    ivec2 texel = texel_of_look(here, i, SEARCH_LOOKS, reach);
    float depth = blocker_depth(here, texel);
    if (depth + bias < receiver_depth(here, texel_place(here, texel))) {
      blockers += 1.0;
      sum += depth;
    }
  }
  if (blockers == 0.0) return 1.0;
  float blocker = sum / blockers, gap = max(here.depth - blocker, 0.0);
  float radius = is_parallel ? size * gap : size * gap / (here.depth * blocker);
  float texel_size = here.depths.z;
  if (radius < 2.0 * texel_size) return hard_share(here, bias);
  float lit = 0.0;
  for (int i = 0; i < FILTER_LOOKS; i++) {
    ivec2 texel = texel_of_look(here, i, FILTER_LOOKS, min(radius, reach));
    lit += blocker_depth(here, texel) + bias >= receiver_depth(here, texel_place(here, texel)) ? 1.0 : 0.0;
  }
  return lit / float(FILTER_LOOKS);
}

// caster: number of the light's first map, of its maps, and its size in units of the shaded view (of a sun as it is).
float lit_share(vec4 caster, vec3 position, vec3 normal) {
  for (int i = 0; i < int(caster.y); i++) {
    ShadowPlace here;
    vec3 plane = dot(shadow_plane, shadow_plane) > 0.0 ? shadow_plane : normal;
    if (!shadow_place(int(caster.x) + i, position, plane, here)) continue;
    float texel = here.depths.z * (here.atlas.w > 0.5 ? 1.0 : here.depth);
    float unit = length(texelFetch(shadow_maps, ivec2(0, int(caster.x) + i), 0).xyz);  // of the light's view
    float size = caster.z * (here.atlas.w > 0.5 ? 1.0 : unit);
    float bias = 0.5 * texel;
    return size > 0.0 ? soft_share(here, bias, size) : hard_share(here, bias);
  }
  return 1.0;
}
