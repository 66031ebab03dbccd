// References: Williams, "Casting Curved Shadows on Curved Surfaces", 1978; Reeves, Salesin, Cook, "Rendering Antialiased
//             Shadows with Depth Maps", 1987 (compare, then filter); Fernando, "Percentage-Closer Soft Shadows", 2005.
// Summary: the share of a light that reaches a point. Depths are compared with the plane of the lit surface, so that a
//          wide filter does not cause self-shadowing; splats are one epsilon farther away in the map. Taps for a lamp
//          are placed relative to the direction to it and over the disc facing the point, not along a face of its cube
//          map, and continue in the next face: shadows have no seams where faces meet.

const int SOFT_SAMPLES = 32;
// Neighbouring samples of the picture use different taps, so a pixel of 2 x 2 samples has four times as many; and so do
// the pictures of which a picture is the mean.
float shadow_turn;
// Normal of the lit plane: the geometric normal, which differs from the shading normal on smooth-shaded surfaces.
vec3 shadow_plane;
// How far the smooth surface that shading normals describe lies above the lit point.
float shadow_lift = 0.0;
const float GOLDEN_ANGLE = 2.39996323;
const float GRAZING = 0.02;  // minimum cosine for following a surface's plane

// Facets of a smooth-shaded mesh that face the light by less than this cosine are lit as the smooth surface is: there
// they would otherwise lie in the shadow of their neighbours, triangle by triangle.
const float TERMINATOR = 0.1;

// The point of the smooth surface that is lit, and its plane. wide: the lamp's half-axis over its distance.
vec3 smooth_place(vec3 position, vec3 normal, vec3 to_light, float wide, out vec3 plane) {
  float turned = clamp(1.0 - (dot(shadow_plane, to_light) - wide) / TERMINATOR, 0.0, 1.0);
  plane = shadow_plane;
  if (!(turned > 0.0 && shadow_lift > 0.0)) return position;
  plane = mix(shadow_plane, normal, turned);
  return position + turned * shadow_lift * normal;
}

struct ShadowPlace {
  int map;
  mat3 turn;     // to the light's view, and to its scale
  vec4 window;
  vec4 atlas;    // x, y, resolution, 1 for a parallel camera
  vec4 depths;   // stored to depth: factor, summand; size of a texel (at depth 1 of a perspective); 1 for a cube's face
  vec3 position; // in the light's view
  vec3 normal;
  float depth;
  vec2 place;    // on the light's window
};

bool shadow_place(int map, vec3 position, vec3 normal, out ShadowPlace here) {
  here.map = map;
  here.turn = transpose(mat3(texelFetch(shadow_maps, ivec2(0, map), 0).xyz, texelFetch(shadow_maps, ivec2(1, map), 0).xyz,
                             texelFetch(shadow_maps, ivec2(2, map), 0).xyz));
  vec3 shift = vec3(texelFetch(shadow_maps, ivec2(0, map), 0).w, texelFetch(shadow_maps, ivec2(1, map), 0).w,
                    texelFetch(shadow_maps, ivec2(2, map), 0).w);
  here.window = texelFetch(shadow_maps, ivec2(3, map), 0);
  here.atlas = texelFetch(shadow_maps, ivec2(4, map), 0);
  here.depths = texelFetch(shadow_maps, ivec2(5, map), 0);
  here.position = here.turn * position + shift;
  here.normal = normalize(here.turn * normal);
  bool is_parallel = here.atlas.w > 0.5;
  here.depth = -here.position.z;
  if (!is_parallel && here.depth <= 0.0) return false;
  here.place = is_parallel ? here.position.xy : here.position.xy / here.depth;
  vec2 at = (here.place - here.window.xy) * here.window.zw;
  return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
}

// Depth of the lit surface's plane at another point; toward.z is -1, seen from the point's own map. It is at most
// `own`, the depth if the surface faced the light: anything farther is behind the lit surface, like the other wall of a
// corner. Near its horizon and beyond, the plane of a lamp is not followed.
float receiver_depth(ShadowPlace here, vec3 toward, float own) {
  if (here.atlas.w > 0.5) {
    float slope = max(abs(here.normal.z), GRAZING) * (here.normal.z < 0.0 ? -1.0 : 1.0);
    return min(here.depth + dot(here.normal.xy, toward.xy - here.place) / slope, own);
  }
  float facing = dot(here.normal, toward), away = dot(here.normal, here.position);
  return abs(facing) > GRAZING * length(toward) && facing * away > 0.0 ? min(away / facing, own) : own;
}

#include "lib/shadow_taps/{shadow_taps}.glsl"

float map_depth(ShadowPlace here, vec2 atlas, ivec2 texel) {
  return texelFetch(shadow_depth, inside_map(texel, int(here.atlas.z)) + ivec2(atlas), 0).r;
}

float blocker_depth(ShadowPlace here, ivec2 texel) {
  float stored = map_depth(here, here.atlas.xy, texel);
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
      lit += blocker_depth(here, texel) + bias >= receiver_depth(here, vec3(texel_place(here, texel), -1.0), here.depth) ? weight : 0.0;
      total += weight;
    }
  }
  return lit / total;
}

// Result of a tap.
struct Met {
  float depth;  // of the map
  float lit;    // of the surface that is lit
  float way;    // distance along the direction from the lamp to the lit point, times its length; for a sun the depth
};

// toward: a point in the light's view. If it leaves a face of a lamp's cube, the next face has it.
Met tap_toward(ShadowPlace here, vec3 toward, int number) {
  bool is_parallel = here.atlas.w > 0.5;
  vec3 row_x = vec3(1.0, 0.0, 0.0), row_y = vec3(0.0, 1.0, 0.0), row_z = vec3(0.0, 0.0, 1.0);
  vec3 next = vec3(here.atlas.xy, here.depths.x);
  vec2 aside = abs(toward.xy);
  if (here.depths.w > 0.5 && max(aside.x, aside.y) > here.window.x * toward.z) {
    vec2 side = aside.x > aside.y ? vec2(toward.x, 0.0) : vec2(toward.y, 6.0);
    int first = 6 + int(side.y) + (side.x < 0.0 ? 0 : 3);
    vec4 x = texelFetch(shadow_maps, ivec2(first, here.map), 0), y = texelFetch(shadow_maps, ivec2(first + 1, here.map), 0),
         z = texelFetch(shadow_maps, ivec2(first + 2, here.map), 0);
    row_x = x.xyz;
    row_y = y.xyz;
    row_z = z.xyz;
    next = vec3(x.w, y.w, z.w);
    toward = vec3(dot(row_x, toward), dot(row_y, toward), dot(row_z, toward));
  }
  float depth = is_parallel ? here.depth : max(-toward.z, 0.1 * here.depth);
  vec2 place = is_parallel ? toward.xy : toward.xy / depth;
  ivec2 texel = soft_texel((place - here.window.xy) * here.window.zw * here.atlas.z, number);
  place = texel_place(here, texel);
  vec3 seen = place.x * row_x + place.y * row_y - row_z;
  float stored = map_depth(here, next.xy, texel);
  Met met;
  met.depth = stored < 1.0 && next.z > 0.0 ? next.z * stored + here.depths.y : 3.4e38;
  met.lit = receiver_depth(here, seen, depth);
  met.way = is_parallel ? met.depth : met.depth * dot(seen, here.position);
  return met;
}

// Blockers outside the cone of rays from the point to the lamp, like the other side of an open fold, hide none of it. In
// the search they hardly count, but they are found there, so that the outermost part of a penumbra is not missed. Of the
// taps that follow, at a mean distance, only those far outside the cone are left out: where a near and a far blocker
// meet, their mean distance says nothing about the near one.
const float LEAST_COUNT = 0.01, WIDEST_CONE = 2.0;

// Rays pass the point towards parts of the lamp, whose half-axes lamp_u and lamp_v are in the light's view (tangents
// for a sun): at the fraction t of the distance from the lamp, their spread is (1 - t) / t of the lamp's size.
float soft_share(ShadowPlace here, float bias, float size, vec3 lamp_u, vec3 lamp_v) {
  bool is_parallel = here.atlas.w > 0.5;
  float reach = is_parallel ? min(here.depth - here.depths.y, 0.25 / (size * max(here.window.z, here.window.w)))
                            : min(1.0 / NEAREST_SHARE, length(here.position) / size) - 1.0;
  reach = max(reach, 0.0);
  // The way to the lit point, like `Met.way`. Of a tap at `past`, the cone is as far before the point as `past` says: by
  // that length for a sun, and by that share of the tap's way for a lamp.
  float whole = is_parallel ? here.depth : dot(here.position, here.position), close = 2.0 * bias / size;
  float blockers = 0.0, sum = 0.0;
  for (int i = 0; i < SEARCH_TAPS; i++) {
    vec2 tap = soft_tap(i, SEARCH_TAPS);
    float past = searched(tap.x) * reach;  // denser in the middle, where close blockers hide the lamp
    Met met = tap_toward(here, here.position + past * (cos(tap.y) * lamp_u + sin(tap.y) * lamp_v), i);
    if (met.depth + bias < met.lit) {
      float before = max(is_parallel ? whole - met.way : whole / met.way - 1.0, 0.0);
      float count = clamp(2.0 - past / (before + close), LEAST_COUNT, 1.0);
      blockers += count;
      sum += count * met.way;
    }
  }
  if (blockers == 0.0) return 1.0;
  float blocker = sum / blockers;
  float gap = max(is_parallel ? whole - blocker : whole / blocker - 1.0, 0.0);
  if (size * gap < 4.0 * bias) return hard_share(here, bias);
  float lit = 0.0, counted = 0.0;
  for (int i = 0; i < FILTER_TAPS; i++) {
    vec2 tap = soft_tap(i, FILTER_TAPS);
    float past = tap.x * min(gap, reach);
    Met met = tap_toward(here, here.position + past * (cos(tap.y) * lamp_u + sin(tap.y) * lamp_v), i);
    float before = max(past - 2.0 * close, 0.0) / WIDEST_CONE;
    bool is_near_cone = is_parallel ? met.way + before <= whole : met.way * (1.0 + before) <= whole;
    bool is_hidden = met.depth + bias < met.lit;
    if (is_hidden && !is_near_cone) continue;
    counted += 1.0;
    lit += is_hidden ? 0.0 : 1.0;
  }
  return counted > 0.0 ? lit / counted : 1.0;
}

// caster: first map of the light, number of its maps, and its size in units of the shaded view (for a sun unchanged).
// half_u, half_v: half-axes of a lamp with a size, in the shaded view.
float lit_share(vec4 caster, vec3 half_u, vec3 half_v, vec3 position, vec3 plane) {
  for (int i = 0; i < int(caster.y); i++) {
    ShadowPlace here;
    if (!shadow_place(int(caster.x) + i, position, plane, here)) continue;
    bool is_parallel = here.atlas.w > 0.5;
    float bias = 0.5 * here.depths.z * (is_parallel ? 1.0 : here.depth);
    if (caster.z == 0.0) return hard_share(here, bias);
    float size = caster.z * (is_parallel ? 1.0 : length(here.turn[0]));
    vec3 lamp_u = is_parallel ? vec3(size, 0.0, 0.0) : here.turn * half_u;
    vec3 lamp_v = is_parallel ? vec3(0.0, size, 0.0) : here.turn * half_v;
    return soft_share(here, bias, size, lamp_u, lamp_v);
  }
  return 1.0;
}
