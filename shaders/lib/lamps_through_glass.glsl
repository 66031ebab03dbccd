// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (GGX); Cycles' Filter Glossy.
// Summary: what glass leaves of a lamp's light on a matt surface. The twin of `lamp_share` in reference/glass.py.

#include "lib/glass_surfaces.glsl"
#include "lib/lamp_lobe.glsl"

const float GLASS_PI = 3.14159265358979, GLASS_GOLDEN_TURN = 2.39996323;
// What bends no light.
const float CLEAR_IOR = 1.001;
// Cycles finds lamps through glass by chance, and therefore takes it for rough where a matt surface is lit (its Filter
// Glossy): GGX alpha of light at 45 degrees. Of light that it spreads so it loses a share at each crossing.
const float LAMP_ALPHA = 0.44, LAMP_LOSS = 0.06;
// It keeps no more than this, times 1 and the cosine: as wide panes in Cycles at 30 and 45 degrees from their plane.
const vec2 LAMP_GRAZING = vec2(0.46, 0.72);
// Rays that are followed towards a lamp, to either side of it by the tangents of a lobe of this width (GGX).
const int LAMP_TAPS = 6, LAMP_CROSSINGS = 8;
const float LAMP_SPREAD = 0.35;
// The most that a ray counts, as a share of the lamp's light.
const float LAMP_MOST = 8.0;

float glass_around;  // by which the rays are turned, radians

// What a crossing keeps of what is not reflected: the roughness that is not the glass's own loses light (GGX, Smith).
float lamp_kept(float cosine, float roughness) {
  float own = min(roughness * roughness / LAMP_ALPHA, 1.0), cosine2 = max(cosine * cosine, 1e-4);
  float masking = 2.0 / (1.0 + sqrt(1.0 + LAMP_ALPHA * LAMP_ALPHA * (1.0 - cosine2) / cosine2));
  return mix(masking * (1.0 - LAMP_LOSS), 1.0, own * own) * min(LAMP_GRAZING.x + LAMP_GRAZING.y * cosine, 1.0);
}

// What glass leaves of a light: of the ray straight to it, if nothing bends that, and of those that are bent towards it.
// Successive samples look towards other places of the lamp.
vec3 lamp_through_glass(Incident here, LightTexels of, vec3 position, vec3 normal) {
  float facing = dot(normal, here.to_light);
  vec2 aside = frame.glass_aside * vec2(cos(frame.glass_turn), sin(frame.glass_turn));
  mat3 turn = mat3(frame.to_glass);
  vec3 toward = turn * (here.middle + here.half_u * aside.x + here.half_v * aside.y), up = normalize(turn * normal);
  vec3 start = (frame.to_glass * vec4(position, 1.0)).xyz, straight = normalize(toward), lamp = start + toward;
  vec3 u = facing_axis(straight), v = cross(straight, u), from = start, along = straight;
  bool is_far = !(of.place.w > 0.5), is_bent = false;
  float far = length(toward), side = -1.0, spread2 = 0.0, spread = LAMP_SPREAD, weight = 1.0, crossed = 0.5 * far;
  vec3 share = vec3(1.0), sum = vec3(0.0);
  int tap = -1, crossings = 0;  // the first ray is the straight one
  for (int i = 0; i < (LAMP_TAPS + 1) * (LAMP_CROSSINGS + 1) && tap < LAMP_TAPS; i++) {
    GlassMet met = met_glass(from, along, side);
    vec3 rest = lamp - from;
    bool goes_on = met.away < (is_far ? FAR : length(rest)) && crossings < LAMP_CROSSINGS;
    if (goes_on) {
      from += along * met.away;
      crossings++;
      if (!met.casts) {
        side = -side;
        continue;
      }
      vec3 against = met.normal * inversesqrt(max(dot(met.normal, met.normal), 1e-20));
      if (dot(against, along) > 0.0) against = -against;
      float ratio = side > 0.0 ? 1.0 / met.ior : met.ior, cosine = clamp(-dot(against, along), 0.0, 1.0);
      if (!(met.ior > CLEAR_IOR)) {
        share *= met.tint;
        side = -side;
        continue;
      }
      is_bent = true;
      if (tap < 0) {
        crossed = distance(from, start);
        side = -side;
        continue;
      }
      float reflected = fresnel_of(cosine, ratio), bends = LAMP_ALPHA * (met.ior - 1.0);
      if (reflected >= 1.0) {
        along = reflect(along, against);
        spread2 += 4.0 * LAMP_ALPHA * LAMP_ALPHA;
        continue;
      }
      along = bent(along, against, cosine, ratio);
      share *= (1.0 - reflected) * lamp_kept(cosine, met.roughness) * met.tint;
      spread2 = spread2 / (ratio * ratio) + bends * bends / (side > 0.0 ? 1.0 : ratio * ratio);
      side = -side;
      continue;
    }
    // the end of a ray
    if (tap < 0) {
      if (!is_bent) sum += share;
      if (!is_far) spread *= clamp(1.0 - crossed / far, 0.01, 1.0);
    } else if (is_bent && side < 0.0 && crossings < LAMP_CROSSINGS) {
      vec3 there = is_far ? straight : normalize(rest);
      float cosine = dot(along, there), nearer = is_far ? 1.0 : far * far / dot(rest, rest);
      if (cosine > 0.0) {
        float found = lamp_lobe(1.0 / (cosine * cosine) - 1.0, max(spread2, 1e-6));
        sum += min(weight * found * nearer, LAMP_MOST) / float(LAMP_TAPS) * share;
      }
    }
    tap++;
    float within = (float(tap) + fract(0.5 + frame.glass_aside * frame.glass_aside)) / float(LAMP_TAPS);
    float slope2 = spread * spread * within / max(1.0 - within, 1e-3), angle = glass_around + float(tap) * GLASS_GOLDEN_TURN;
    along = normalize(straight + sqrt(slope2) * (u * cos(angle) + v * sin(angle)));
    weight = max(dot(along, up), 0.0) / (facing * lamp_lobe(slope2, spread * spread));
    from = start;
    share = vec3(1.0);
    spread2 = 0.0;
    crossings = 0;
    side = -1.0;
    is_bent = false;
  }
  return sum;
}
