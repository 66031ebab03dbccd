// References: lib/shadow.glsl.
// Summary: the part of each light that is blocked. Splats are summed with their geometric normals, beside depths or
//          separately; the offset of casters has its twin in reference/shadows.py.

#part lights
#include "lib/shadow.glsl"

const float ROUND = 1.12837917;  // axes of an ellipse over half-sides of a rectangle of its area: sqrt(4 / pi)

// The visible part of a flat light's axis.
vec3 turned_to(vec3 to_light, vec3 axis) {
  return axis - dot(axis, to_light) * to_light;
}

void shadows_hide(inout Incident here, LightTexels of, vec3 position, vec3 normal) {
  vec4 caster = texelFetch(lights, ivec2(6, of.number), 0);
  if (caster.y > 0.0 && dot(here.irradiance, vec3(1.0)) > 0.0) {
    vec3 half_u = vec3(0.0), half_v = vec3(0.0);
    if (caster.z > 0.0) {
      vec4 side = texelFetch(lights, ivec2(4, of.number), 0);
      bool is_flat = side.w > 0.5;
      half_u = is_flat ? ROUND * turned_to(here.to_light, of.u.xyz) : facing_axis(here.to_light) * caster.z;
      half_v = is_flat ? ROUND * turned_to(here.to_light, side.xyz) : cross(here.to_light, half_u);
    }
    float wide = max(length(half_u), length(half_v)) / max(length(here.middle), 1e-30);
    vec3 plane;
    vec3 place = smooth_place(position, normal, here.to_light, caster.z > 0.0 ? wide : 0.0, plane);
    float lit = lit_share(caster, half_u, half_v, place, plane);
    here.irradiance *= lit;
    here.radiance *= lit;
  }
}

#part visibility.vert, shadow
// Splats of a smooth surface reach over its edges and lie in front of the surface beyond. In front of a plane that is
// turned away by this angle, they do so by up to its sine in radii. Shadow casters are therefore moved back far enough
// not to shadow that plane: the more grazing the light, the farther, up to a limit that keeps shadows attached to their
// casters.
const float SIN_BEND = 0.5, COS_BEND = 0.8660254;
const float FARTHEST_BACK = 4.0;  // epsilons

void shadows_move(Splat splat, float radius, inout float offset) {
  float facing = abs(outward_cosine(splat.position, splat.axis_u, splat.axis_v, 1.0, view.is_parallel > 0.5));
  float turned = facing * COS_BEND - sqrt(max(1.0 - facing * facing, 0.0)) * SIN_BEND;
  offset = draw.epsilon * radius * min(1.0 / max(turned, 1e-3), FARTHEST_BACK);
}

#part splat_varyings, adds_planes
#include "lib/faced_normal.glsl"
void shadows_tell(Splat splat, int index) {
  vec3 plane = geometric_normal(splat);
  splat_faces = plane.xy / max(1.0 + plane.z, LEAST_FACED);
}

#part splat_varyings, adds_planes, lifted
#include "lib/surfel_lift.glsl"
void shadows_lifted_tell(Splat splat, int index) {
  splat_lift = surfel_lift(splat, index);
}

#part gbuffer, lifted
void shadows_lifted_weigh(inout Fragment f) {
  f.lift = splat_lift;
}

#part gbuffer, planes_apart, lifted
void shadows_lifted_add(inout Fragment f) {
  gbuffer_plane.zw = vec2(0.0, f.lift * f.weight);
}

#part gbuffer, planes_apart
void shadows_add(inout Fragment f) {
  gbuffer_plane.xy = splat_faces * f.weight;
}

#part gbuffer, planes_beside_depths
void shadows_add(inout Fragment f) {
  gbuffer_depth.zw = splat_faces * f.weight;
}

#part shaded_sample
#include "lib/faced_normal.glsl"
void shadows_prepare(inout Shaded s) {
  shadow_turn = fract(frame.shadow_turn + 0.25 * float((s.texel.x & 1) + 2 * (s.texel.y & 1)));
}

#part shaded_sample, planes_apart
void shadows_planes_apart_prepare(inout Shaded s) {
  shadow_plane = faced_normal(SUM_AT(gbuffer_plane, s.texel, s.tap).xy / max(s.mean.weight, 1e-37));
}

#part shaded_sample, planes_beside_depths
void shadows_planes_beside_depths_prepare(inout Shaded s) {
  vec4 sums = SUM_AT(gbuffer_depth, s.texel, s.tap);
  shadow_plane = faced_normal(sums.zw / max(sums.y, 1e-37));
}

#part shaded_sample, planes_apart, lifted
void shadows_lifted_prepare(inout Shaded s) {
  shadow_lift = SUM_AT(gbuffer_plane, s.texel, s.tap).w / max(s.mean.weight, 1e-37);
}

#part shaded_sample, planes_beside_depths, lifted
void shadows_lifted_prepare(inout Shaded s) {
  shadow_lift = SUM_AT(gbuffer_normal, s.texel, s.tap).w / max(SUM_AT(gbuffer_depth, s.texel, s.tap).y, 1e-37);
}

#part shaded_sample, polygons
void shadows_polygons_prepare(inout Shaded s) {
  if (s.mean.polygon > 0.5) {
    vec4 plane = SUM_AT(polygon_plane, s.texel, s.tap);
    shadow_plane = plane.xyz;
    shadow_lift = plane.w / s.mean.sees;
  }
}

#part lit_splats.frag
#include "lib/faced_normal.glsl"
void shadows_prepare(Splat splat, int index) {
  shadow_turn = fract(frame.shadow_turn + 0.25 * float(index & 3));
  shadow_plane = geometric_normal(splat);
}

#part lit_splats.frag, lifted
#include "lib/surfel_lift.glsl"
void shadows_lifted_prepare(Splat splat, int index) {
  shadow_lift = surfel_lift(splat, index);
}
