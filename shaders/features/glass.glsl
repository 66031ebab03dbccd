// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (how rough surfaces spread what
//             crosses them); McGuire, Mara, "Efficient GPU Screen-Space Ray Tracing", JCGT 2014 (steps that are even in
//             the picture); Cycles' Principled and Glass BSDF (tints).
// Summary: follows light from a surface of glass back through all surfaces of glass, to where it meets the picture of
//          what is behind glass, and else to the probes and the world. Textures: rendering/probes/glass.py and
//          scene/glass_surfaces.py. The twin of reference/glass.py.

#part principled
#include "lib/finish.glsl"
#include "lib/picture_maps.glsl"

vec3 glass_place;     // of the surface, view space
vec3 glass_material;  // roughness, metallic, reflectance at normal incidence
vec3 glass_tint;      // what a crossing keeps
vec3 glass_passed;    // share of what comes through that leaves the surface
vec3 glass_normal;

vec3 facing_axis_of(vec3 along) {
  return normalize(cross(abs(along.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), along));
}

const int GLASS_CROSSINGS = 10;
// Boxes that are looked at for one ray, at most: llvmpipe ends all loops of a shader after 65,535 turns.
const int GLASS_VISITS = 1500;
const float FAR = 1e30;
const float THINNEST = 1e-10;  // square of the sine of a triangle's angle, at least

// What a ray meets.
struct GlassMet {
  float away;  // FAR for nothing
  vec3 normal;
  vec3 tint;
  float ior;
  float roughness;
};

float fresnel_of(float cosine, float ratio) {  // ratio: of the indices, behind the surface over before it
  float sine2 = (1.0 - cosine * cosine) / (ratio * ratio);
  if (sine2 >= 1.0) return 1.0;
  float behind = sqrt(1.0 - sine2);
  float across = (cosine - ratio * behind) / (cosine + ratio * behind);
  float along = (ratio * cosine - behind) / (ratio * cosine + behind);
  return 0.5 * (across * across + along * along);
}

// Behind a surface that faces the ray; along it where nothing is refracted.
vec3 bent(vec3 along, vec3 against, float cosine, float ratio) {
  float square = 1.0 - (1.0 - cosine * cosine) / (ratio * ratio);
  return normalize(along / ratio + against * (cosine / ratio - sqrt(max(square, 0.0))));
}

vec4 pane_texel(int number, int first_row) {
  return texelFetch(glass_surfaces, ivec2(number % GLASS_ROW, first_row + number / GLASS_ROW), 0);
}

// A triangle or disc, if the ray meets it on the side: 1 where it leaves glass, -1 where it enters. Of discs that overlap
// the nearest counts, and the others by how near they are to their middles.
void meet_glass(int number, vec3 from, vec3 along, float side, inout GlassMet met, inout float weights, inout vec3 normals) {
  int first = number * TEXELS_PER_GLASS, row = int(frame.glass_box_rows);
  vec4 n0 = pane_texel(first + 3, row), n1 = pane_texel(first + 4, row), n2 = pane_texel(first + 5, row);
  if (!(n2.w > 0.0)) return;
  vec4 a = pane_texel(first, row), b = pane_texel(first + 1, row), c = pane_texel(first + 2, row);
  bool is_disc = n2.w > 1.5;
  vec3 u = is_disc ? b.xyz : b.xyz - a.xyz, v = is_disc ? c.xyz : c.xyz - a.xyz, flat_normal = cross(u, v);
  if (is_disc) flat_normal *= sign(dot(flat_normal, n0.xyz));
  float facing = dot(flat_normal, along);
  if (!(facing * side > 0.0)) return;
  float away = dot(flat_normal, a.xyz - from) / facing;
  if (!(away > 0.0)) return;
  vec3 at = from + along * away - a.xyz;
  float uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), au = dot(at, u), av = dot(at, v);
  float area = dot(flat_normal, flat_normal);
  if (!(area > THINNEST * uu * vv)) return;
  vec2 place = vec2(vv * au - uv * av, uu * av - uv * au) / area;
  float weight = is_disc ? 1.0 - dot(place, place) : min(min(place.x, place.y), 1.0 - place.x - place.y) + 1e-5;
  if (!(weight >= 0.0)) return;
  float thick = is_disc ? 0.5 * sqrt(max(uu, vv)) : 0.0;
  if (away > met.away + thick) return;
  vec3 normal = is_disc ? n0.xyz : n0.xyz * (1.0 - place.x - place.y) + n1.xyz * place.x + n2.xyz * place.y;
  if (away < met.away - thick) { weights = 0.0; normals = vec3(0.0); }
  weights += weight;
  normals += is_disc ? normal * weight : normal;
  if (away < met.away) met = GlassMet(away, vec3(0.0), vec3(a.w, b.w, c.w), n0.w, n1.w);
}

// What a ray meets first of what is on its side.
GlassMet met_glass(vec3 from, vec3 along, float side) {
  GlassMet met = GlassMet(FAR, vec3(0.0), vec3(1.0), 1.0, 0.0);
  vec3 inverse = 1.0 / mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20)));
  int leaves = int(frame.glass_leaves), node = 1;
  float weights = 0.0;
  vec3 normals = vec3(0.0);
  for (int visits = 0; visits < GLASS_VISITS; visits++) {
    vec3 low = pane_texel(2 * node, 0).xyz, high = pane_texel(2 * node + 1, 0).xyz;
    bool is_empty = low.x > high.x;
    low = (low - from) * inverse;
    high = (high - from) * inverse;
    vec3 first = min(low, high), last = max(low, high);
    float enters = max(max(first.x, first.y), max(first.z, 0.0)), leaves_at = min(min(last.x, last.y), last.z);
    if (!is_empty && enters <= leaves_at * 1.00001 + 1e-6 && enters <= met.away) {
      if (node < leaves) {
        node *= 2;
        continue;
      }
      int number = (node - leaves) * GLASS_LEAF;
      for (int k = 0; k < GLASS_LEAF; k++) meet_glass(number + k, from, along, side, met, weights, normals);
    }
    // to the next node that is not below this one; behind the last there is none
    node += 1;
    node /= node & -node;
    if (node == 1) break;
  }
  met.normal = normals;
  return met;
}

vec4 behind_at(int number, vec2 place) {
  PictureTexels at = picture_texels(picture_map(ivec2(frame.glass_size), number), number, place);
  vec4 below = mix(texelFetch(glass_picture, at.low_high.xy, 0), texelFetch(glass_picture, at.low_high.zy, 0), at.share.x);
  vec4 above = mix(texelFetch(glass_picture, at.low_high.xw, 0), texelFetch(glass_picture, at.low_high.zw, 0), at.share.x);
  return mix(below, above, at.share.y);
}

// Depth of what is behind glass, view units; FAR for nothing.
float behind_depth_at(vec2 place) {
  ivec2 size = ivec2(frame.glass_size), texel = clamp(ivec2(floor(place)), ivec2(0), size - 1);
  float depth = texelFetch(glass_picture, texel + ivec2(0, size.y), 0).r;
  return depth > 0.0 ? depth * frame.glass_scale : FAR;
}

const int GLASS_STEPS = 32, GLASS_HALVINGS = 5;
const float GLASS_STRIDE = 3.0;  // pixels of a step, at least
// How far behind what begins to hide it a ray may be and still meet it, as a share of the depth.
const float GLASS_BEHIND = 0.05;

// A stretch of a ray in the picture: places in pixels and depths' inverses at its ends, or depths of a parallel view.
struct GlassWay {
  vec3 start;
  vec3 end;
};

vec3 in_picture(vec3 position) {
  bool is_parallel = view.is_parallel > 0.5;
  vec2 seen = is_parallel ? position.xy : position.xy / -position.z;
  return vec3((seen - frame.glass_window.xy) * frame.glass_window.zw, is_parallel ? -position.z : -1.0 / position.z);
}

float way_depth(vec3 at) {
  return view.is_parallel > 0.5 ? at.z : 1.0 / max(at.z, 1.0 / FAR);
}

// from, along: view space, along in view units per unit. reach: FAR without an end.
GlassWay picture_way(vec3 from, vec3 along, float reach) {
  GlassWay way;
  way.start = in_picture(from);
  bool is_parallel = view.is_parallel > 0.5;
  if (!is_parallel && along.z > 0.0) reach = min(reach, 0.99 * -from.z / along.z);
  if (is_parallel && reach >= FAR) reach = 1e4 * frame.glass_size.x / frame.glass_window.z / length(along);
  if (reach < FAR) {
    way.end = in_picture(from + along * reach);
  } else {
    vec2 seen = along.z < 0.0 ? along.xy / -along.z : along.xy * 1e6;
    way.end = vec3((seen - frame.glass_window.xy) * frame.glass_window.zw, 0.0);
  }
  // no farther than the picture's edge
  vec2 change = way.end.xy - way.start.xy, room = mix(-way.start.xy, frame.glass_size - way.start.xy, step(0.0, change));
  vec2 shares = room / mix(change, vec2(1e-9), lessThan(abs(change), vec2(1e-9)));
  float share = clamp(min(abs(change.x) > 1e-9 ? shares.x : 1.0, abs(change.y) > 1e-9 ? shares.y : 1.0), 0.0, 1.0);
  way.end = mix(way.start, way.end, share);
  return way;
}

// Where a stretch of a ray meets what is in the picture: place in pixels, depth; whether it does. is_open: whether it
// ends before nothing.
bool met_in_picture(GlassWay way, out vec3 found, out bool is_open) {
  float pixels = length(way.end.xy - way.start.xy);
  int steps = int(clamp(ceil(pixels / GLASS_STRIDE), 1.0, float(GLASS_STEPS)));
  vec3 low = way.start;
  float seen = behind_depth_at(low.xy), before = way_depth(low) - seen;
  for (int i = 1; i <= steps; i++) {
    vec3 high = mix(way.start, way.end, float(i) / float(steps));
    seen = behind_depth_at(high.xy);
    float after = way_depth(high) - seen;
    if (before <= 0.0 && after > 0.0) {
      vec3 near = low, far = high;
      for (int k = 0; k < GLASS_HALVINGS; k++) {
        vec3 middle = 0.5 * (near + far);
        if (way_depth(middle) > behind_depth_at(middle.xy)) far = middle; else near = middle;
      }
      float depth = behind_depth_at(far.xy);
      if (way_depth(near) < depth * (1.0 + GLASS_BEHIND)) {
        found = vec3(far.xy, depth);
        return true;
      }
    }
    low = high;
    before = after;
  }
  is_open = before <= 0.0;
  return false;
}

// A texel that is looked up, over the spread of a ray.
const float GLASS_TEXEL = 0.7;

// Roughness of a surface that reflects as wide a lobe.
float roughness_of(float texel) {
  return min(sqrt(texel / (2.0 * GLASS_TEXEL)), 1.0);
}

// texel: the width that is looked up, pixels.
vec4 behind_mapped(vec2 place, float texel) {
  float number = clamp(log2(max(texel, 1.0)), 0.0, float(PICTURE_MAPS - 1));
  int finer = int(number);
  vec4 seen = behind_at(finer, place);
  return number > float(finer) ? mix(seen, behind_at(finer + 1, place), number - float(finer)) : seen;
}

// What a ray may meet. texel: the angle that is looked up, and that beyond a distance.
struct GlassRay {
  vec3 from;
  vec3 along;
  float reach;  // FAR without an end
  vec2 texel;
  float beyond;
};

// The light that a ray meets in the picture; whether it meets any. is_open: whether it ends before nothing.
bool seen_along(GlassRay ray, out vec3 light, out bool is_open) {
  vec3 start = (frame.from_glass * vec4(ray.from, 1.0)).xyz, way = mat3(frame.from_glass) * ray.along, found;
  is_open = false;
  light = vec3(0.0);
  if (!(view.is_parallel > 0.5) && !(start.z < 0.0)) return false;
  vec3 first = in_picture(start);
  if (any(lessThan(first.xy, vec2(0.0))) || any(greaterThan(first.xy, frame.glass_size))) return false;
  GlassWay stretch = picture_way(start, way, ray.reach);
  if (!met_in_picture(stretch, found, is_open)) {
    is_open = is_open && ray.reach >= FAR && way.z < 0.0 && way_depth(stretch.end) >= 0.5 * FAR;
    return false;
  }
  float away = abs(found.z + start.z) / max(abs(way.z), 0.1 * frame.glass_scale);
  float texel = away > ray.beyond ? ray.texel.y : ray.texel.x, depth = view.is_parallel > 0.5 ? 1.0 : found.z;
  vec4 seen = behind_mapped(found.xy, texel * away * frame.glass_scale / depth * frame.glass_window.w);
  light = seen.rgb;
  if (seen.a < 1.0) light += (1.0 - seen.a) * sent_reflection(normalize(way), roughness_of(texel));
  return true;
}

// Light from beyond all glass. place: of the surface that is lit, view space.
vec3 light_along(GlassRay ray, vec3 place) {
  vec3 light;
  bool is_open;
  if (seen_along(ray, light, is_open)) return light;
  vec3 direction = normalize(mat3(frame.from_glass) * ray.along);
  if (is_open) return sent_reflection(direction, roughness_of(ray.texel.y));
  vec3 away = (frame.from_glass * vec4(ray.from, 1.0)).xyz - place;
  return world_through(away, direction, roughness_of(ray.texel.y));
}

const int GLASS_TAPS = 12;
const float GOLDEN_TURN = 2.39996323;
// From this spread on, radians, rays are told apart.
const float FROSTED = 0.01;

// What a rough surface lets through around a ray, whose spread is that of its lobe (GGX), with long tails. Rays have
// equal shares of it, and each is as wide as its share. more: square of the spread beyond a distance.
vec3 light_around(GlassRay ray, float spread, float more, vec3 place) {
  vec3 u = facing_axis_of(ray.along), v = cross(ray.along, u), along = ray.along, total = vec3(0.0);
  for (int i = 0; i < GLASS_TAPS; i++) {
    float within = (float(i) + 0.5) / float(GLASS_TAPS), turn = float(i) * GOLDEN_TURN + frame.glass_turn;
    float slope = spread * sqrt(within / (1.0 - within));
    float side = 1.77245385 * (slope * slope + spread * spread) / (spread * sqrt(float(GLASS_TAPS)));
    ray.along = normalize(along + slope * (u * cos(turn) + v * sin(turn)));
    ray.texel = vec2(side, sqrt(side * side + more));
    total += light_along(ray, place);
  }
  return total / float(GLASS_TAPS);
}

vec3 through_glass(vec3 position, vec3 normal) {
  vec3 eye = view.is_parallel > 0.5 ? vec3(0.0, 0.0, -1.0) : normalize(position);
  vec3 from = (frame.to_glass * vec4(position, 1.0)).xyz;
  vec3 along = normalize(mat3(frame.to_glass) * eye), facing = normalize(mat3(frame.to_glass) * normal);
  float root = sqrt(clamp(glass_material.z, 0.0, 0.98)), ior = (1.0 + root) / (1.0 - root);
  float alpha = glass_material.x * glass_material.x, spread2 = alpha * alpha * (ior - 1.0) * (ior - 1.0) / (ior * ior);
  if (dot(facing, along) > -1e-3) facing = normalize(facing - along * (dot(facing, along) + 1e-3));
  along = bent(along, facing, -dot(facing, along), ior);
  vec3 share = glass_tint, lost = vec3(0.0), seen;
  float side = 1.0, frosted2 = 0.0;
  bool is_open = false;
  GlassRay before;  // where a rough surface has been left
  for (int i = 0; i < GLASS_CROSSINGS; i++) {
    GlassMet met = met_glass(from, along, side);
    if (frosted2 == 0.0) {
      if (side < 0.0 && spread2 > FROSTED * FROSTED) {
        frosted2 = spread2;
        before = GlassRay(from, along, FAR, vec2(0.0), met.away);
      } else {
        vec2 texel = vec2(GLASS_TEXEL * sqrt(spread2));
        if (seen_along(GlassRay(from, along, met.away, texel, FAR), seen, is_open)) return share * seen;
      }
    }
    if (met.away >= FAR) break;
    from += along * met.away;
    vec3 against = met.normal * inversesqrt(max(dot(met.normal, met.normal), 1e-20));
    if (dot(against, along) > 0.0) against = -against;
    float ratio = side > 0.0 ? 1.0 / met.ior : met.ior, cosine = clamp(-dot(against, along), 0.0, 1.0);
    float reflected = fresnel_of(cosine, ratio), rough = met.roughness * met.roughness, bends = rough * (met.ior - 1.0);
    if (reflected >= 1.0) {
      along = reflect(along, against);
      spread2 += 4.0 * rough * rough;
      continue;
    }
    along = bent(along, against, cosine, ratio);
    lost += share * reflected;
    share *= (1.0 - reflected) * met.tint;
    spread2 = spread2 / (ratio * ratio) + bends * bends / (side > 0.0 ? 1.0 : ratio * ratio);
    side = -side;
  }
  if (frosted2 > 0.0) {
    // what its other surfaces reflect is spread too, and comes from all around
    return lost * world_through(vec3(0.0), normal, 1.0)
        + share * light_around(before, sqrt(frosted2), max(spread2 - frosted2, 0.0), position);
  }
  vec3 direction = normalize(mat3(frame.from_glass) * along);
  float roughness = roughness_of(GLASS_TEXEL * sqrt(spread2));
  if (is_open) return share * sent_reflection(direction, roughness);
  vec3 away = (frame.from_glass * vec4(from, 1.0)).xyz - position;
  return share * world_through(away, direction, roughness);
}

void glass_dim(inout Lobe lobe, vec3 base, float metallic) {
  vec4 numbers = finish_numbers(2);
  float share = numbers.y * (1.0 - metallic);
  lobe.diffuse_albedo *= 1.0 - share;
  glass_passed = share * max(1.0 - lobe.specular_albedo, vec3(0.0));
  glass_tint = pow(max(base, vec3(1e-9)), vec3(numbers.z / max(numbers.y, 1e-6)));
  glass_normal = lobe.normal;
}

void glass_mirror(inout vec3 radiance) {
  if (max(max(glass_passed.r, glass_passed.g), glass_passed.b) > 0.0) {
    radiance += glass_passed * through_glass(glass_place, glass_normal);
  }
}

#part principled, covered
void glass_below_cover(inout Lobe lobe) {
  glass_passed *= passed_on;
}

#part shaded_sample
void glass_prepare(inout Shaded s) {
  glass_place = eye_position(s.texel, s.mean.depth);
  glass_material = s.material;
}
