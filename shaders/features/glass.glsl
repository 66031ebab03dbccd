// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (how rough surfaces spread what
//             crosses them); Cycles' Principled and Glass BSDF (tints).
// Summary: follows light from a surface of glass back through all surfaces of glass, to where it meets the picture of
//          what is behind glass, and else to the probes and the world. Textures: rendering/probes/glass.py and
//          scene/glass_surfaces.py. The twin of reference/glass.py.

#part principled, see_through
#include "lib/finish.glsl"
#include "lib/glass_surfaces.glsl"
#include "lib/picture_march.glsl"

vec3 glass_place;     // of the surface, view space
vec3 glass_material;  // roughness, metallic, reflectance at normal incidence
vec3 glass_tint;      // what a crossing keeps
vec3 glass_passed;    // share of what comes through that leaves the surface
vec3 glass_normal;

vec3 facing_axis_of(vec3 along) {
  return normalize(cross(abs(along.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), along));
}

const int GLASS_CROSSINGS = 10;

// A texel that is looked up, over the spread of a ray.
const float GLASS_TEXEL = 0.7;

// Roughness of a surface that reflects as wide a lobe.
float roughness_of(float texel) {
  return min(sqrt(texel / (2.0 * GLASS_TEXEL)), 1.0);
}

// A ray along which light is looked for.
struct GlassRay {
  vec3 from;
  vec3 along;
  float reach;  // FAR without an end
  vec2 texel;  // the angle that is looked up, and that beyond a distance
  float beyond;
};

// The light that a ray meets in the picture or, if it ends beyond all glass, in the probes and the world; whether it
// meets any. place: of the surface that is lit, view space.
bool light_along(GlassRay ray, bool looks, bool ends, vec3 place, out vec3 light) {
  vec3 start = (frame.from_glass * vec4(ray.from, 1.0)).xyz, way = mat3(frame.from_glass) * ray.along, found;
  vec3 first = in_picture(start);
  vec4 seen = vec4(0.0);
  float roughness = roughness_of(ray.texel.y);
  bool is_met = false, is_open = false;
  looks = looks && (view.is_parallel > 0.5 || start.z < 0.0) && all(greaterThanEqual(first.xy, vec2(0.0)));
  if (looks && all(lessThanEqual(first.xy, frame.screen_size))) {
    PictureWay stretch = picture_way(start, way, ray.reach);
    is_met = met_in_picture(stretch, found, is_open);
    if (is_met) {
      float away = abs(found.z + start.z) / max(abs(way.z), 0.1 * frame.screen_scale);
      float texel = away > ray.beyond ? ray.texel.y : ray.texel.x, depth = view.is_parallel > 0.5 ? 1.0 : found.z;
      seen = picture_mapped_at(found.xy, texel * away * frame.screen_scale / depth * frame.screen_window.w);
      roughness = roughness_of(texel);
    } else {
      is_open = is_open && way.z < 0.0 && way_depth(stretch.end) >= 0.5 * FAR;
    }
  }
  light = seen.rgb;
  if (is_met || is_open) {
    if (seen.a < 1.0) light += (1.0 - seen.a) * sent_reflection(normalize(way), roughness);
    return is_met || ends;
  }
  if (ends) light = world_through(start - place, normalize(way), roughness);
  return ends;
}

const int GLASS_TAPS = 12;
const float GOLDEN_TURN = 2.39996323;
// From this spread on, radians, rays are told apart.
const float FROSTED = 0.01;
// A ray that keeps less of its light meets no more surfaces.
const float GLASS_LEAST = 0.01;

// One of the rays into which a rough surface parts one, whose spread is that of its lobe (GGX), with long tails. They
// have equal shares of it, and each is as wide as its share. more: square of the spread beyond a distance.
GlassRay parted(GlassRay ray, int number, float spread, float more) {
  vec3 u = facing_axis_of(ray.along), v = cross(ray.along, u);
  float within = (float(number) + 0.5) / float(GLASS_TAPS), turn = float(number) * GOLDEN_TURN + frame.glass_turn;
  float slope = spread * sqrt(within / (1.0 - within));
  float side = 1.77245385 * (slope * slope + spread * spread) / (spread * sqrt(float(GLASS_TAPS)));
  ray.along = normalize(ray.along + slope * (u * cos(turn) + v * sin(turn)));
  ray.texel = vec2(side, sqrt(side * side + more));
  return ray;
}

// Where light leaves glass towards lamps.
struct GlassExit {
  vec3 place;  // relative to the surfaces' origin
  vec3 along;
  vec3 share;
  float spread2;
  float reach;  // to the next surface, FAR for none
};

GlassExit glass_exits[2];  // the first and the last; a share of 0 for none

float most_of(vec3 color) {
  return max(max(color.r, color.g), color.b);
}

// One loop follows a ray, and then looks along those into which a rough surface has parted it: drivers copy functions to
// each of their calls.
vec3 through_glass(vec3 position, vec3 normal) {
  vec3 eye = view.is_parallel > 0.5 ? vec3(0.0, 0.0, -1.0) : normalize(position);
  vec3 from = (frame.to_glass * vec4(position, 1.0)).xyz;
  vec3 along = normalize(mat3(frame.to_glass) * eye), facing = normalize(mat3(frame.to_glass) * normal);
  float root = sqrt(clamp(glass_material.z, 0.0, 0.98)), ior = (1.0 + root) / (1.0 - root);
  float alpha = glass_material.x * glass_material.x, spread2 = alpha * alpha * (ior - 1.0) * (ior - 1.0) / (ior * ior);
  // what its other surfaces reflect of rough glass is spread too, and comes from all around
  GlassRay around = GlassRay(from, facing, FAR, vec2(2.0), FAR), before = around, ray;
  if (dot(facing, along) > -1e-3) facing = normalize(facing - along * (dot(facing, along) + 1e-3));
  along = bent(along, facing, -dot(facing, along), ior);
  vec3 share = glass_tint, lost = vec3(0.0), light = vec3(0.0), seen;
  float side = 1.0, frosted2 = 0.0;
  glass_exits[0] = glass_exits[1] = GlassExit(from, along, vec3(0.0), 0.0, FAR);
  int part = -1;  // the next of the rays into which it has been parted; -1 as long as one is followed
  for (int i = 0; i < GLASS_CROSSINGS + GLASS_TAPS + 2; i++) {
    GlassMet met = GlassMet(FAR, vec3(0.0), vec3(1.0), 1.0, 0.0, false);
    bool looks = true, ends = true;
    vec3 counts = share;
    if (part < 0) {
      bool goes_on = i < GLASS_CROSSINGS && most_of(share) > GLASS_LEAST;
      if (!goes_on && side > 0.0 && frosted2 == 0.0) break;  // what does not leave glass is black, as in Cycles
      if (goes_on) met = met_glass(from, along, side);
      if (goes_on && side < 0.0) {
        int number = most_of(glass_exits[0].share) > 0.0 ? 1 : 0;
        glass_exits[number] = GlassExit(from, along, share, spread2, met.away);
      }
      if (frosted2 == 0.0 && side < 0.0 && spread2 > FROSTED * FROSTED) {
        frosted2 = spread2;
        before = GlassRay(from, along, FAR, vec2(0.0), met.away);
      }
      ends = met.away >= FAR;
      looks = frosted2 == 0.0;
      ray = GlassRay(from, along, met.away, vec2(GLASS_TEXEL * sqrt(spread2)), FAR);
      if (ends && !looks) part = 0;
    }
    if (part == GLASS_TAPS) {
      ray = around;
      counts = lost;
      looks = false;
    } else if (part >= 0) {
      ray = parted(before, part, sqrt(frosted2), max(spread2 - frosted2, 0.0));
      counts = share / float(GLASS_TAPS);
      looks = true;
    }
    bool is_done = false;
    if (looks || part >= 0) is_done = light_along(ray, looks, ends, position, seen);
    if (is_done) {
      light += counts * seen;
      if (part < 0 || part == GLASS_TAPS) break;
      part++;
      continue;
    }
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
  return light;
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

#part lights, see_through
bool lamp_is_far;  // a direction

void see_through_hide(inout Incident here, LightTexels of, vec3 position, vec3 normal) {
  lamp_is_far = !(of.place.w > 0.5);
}

#part principled, see_through, lights
#include "lib/lamp_lobe.glsl"

// A lobe that is narrower shows no lamp, as no ray finds one.
const float LAMP_NARROWEST = 1e-6;

// Lamps shine through rough glass. The normal that they get is turned away from them, so that glass does not dim them.
void glass_lit(inout vec3 radiance, Lobe lobe, vec3 position, vec3 normal) {
  if (!(most_of(glass_passed) > 0.0)) return;
  int count = int(frame.light_count);
  for (int i = 0; i < 2 * count; i++) {
    GlassExit at = glass_exits[i < count ? 0 : 1];
    if (!(most_of(at.share) > 0.0)) continue;
    vec3 along = normalize(mat3(frame.from_glass) * at.along);
    Incident light = incident(i < count ? i : i - count, (frame.from_glass * vec4(at.place, 1.0)).xyz, -along);
    vec3 toward = mat3(frame.to_glass) * light.middle;
    float away2 = dot(light.middle, light.middle), ahead = dot(light.middle, along);
    float width2 = at.spread2 + dot(light.half_u, light.half_u) / max(away2, 1e-30);
    bool reaches = at.reach >= FAR || (!lamp_is_far && dot(toward, toward) < at.reach * at.reach);
    if (!reaches || !(ahead > 0.0) || !(width2 > LAMP_NARROWEST)) continue;
    float found = lamp_lobe(away2 / (ahead * ahead) - 1.0, width2);
    radiance += glass_passed * at.share * light.irradiance * found;
  }
}

#part principled, see_through, covered
void glass_below_cover(inout Lobe lobe) {
  glass_passed *= passed_on;
}

#part shaded_sample, see_through
void glass_prepare(inout Shaded s) {
  glass_place = eye_position(s.texel, s.mean.depth);
  glass_material = s.material;
}

#part shaded_sample, glass_shadows
void glass_shadows_prepare(inout Shaded s) {
  glass_around = frame.glass_turn + 0.5 * GLASS_PI * float((s.texel.x & 1) + 2 * (s.texel.y & 1));
}

#part lights, glass_shadows
#include "lib/lamps_through_glass.glsl"

void glass_hide(inout Incident here, LightTexels of, vec3 position, vec3 normal) {
  bool casts = texelFetch(lights, ivec2(6, of.number), 0).w > 0.0, is_lit = dot(here.irradiance, vec3(1.0)) > 0.0;
  if (!casts || !is_lit || !(dot(normal, here.to_light) > 0.0)) return;
  vec3 left = lamp_through_glass(here, of, position, normal);
  here.irradiance *= left;
  here.radiance *= left;
}
