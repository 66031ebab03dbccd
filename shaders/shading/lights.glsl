// References: Blender manual, "Light Objects" (units); Cycles' spot falloff (a smooth step between cosines).
// Summary: what each light sends to a place: the texels of rendering/light.py as a direction, an irradiance and, of a
//          light with a size, four corners. A round light is a square of its area that faces the place, as Cycles takes a disc there.

#ifdef LIGHT_SET_TARGET
vec4 light_set;  // of the sample that is shaded: its share of each set of objects
#endif

#ifdef SHADOWS
#include "shading/shadow.glsl"
#endif

#ifdef SHADOW_SHARE
vec3 light_arriving, light_unshadowed;  // at the sample that is shaded: sums of irradiance

// Of each colour; 0 where no light comes from the front, as EEVEE has it.
vec3 shadow_share() {
  return light_arriving / mix(light_unshadowed, vec3(1.0), equal(light_unshadowed, vec3(0.0)));
}
#endif

struct Incident {
  vec3 to_light;    // unit
  vec3 irradiance;  // of a surface that faces it
  bool is_sized;
  vec3 middle;      // from the place to the light, and the half-axes of its square
  vec3 half_u;
  vec3 half_v;
  vec3 radiance;    // of the square
};

const float ROUND = 1.12837917;  // axes of an ellipse over half-sides of a rectangle of its area: sqrt(4 / pi)
const float LEAST_SIZE = 2e-3;  // half-side over distance, below which a light is a point

// Unit, across the way to a light.
vec3 facing_axis(vec3 to_light) {
  return normalize(cross(abs(to_light.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), to_light));
}

// What is seen of an axis of a flat light.
vec3 turned_to(vec3 to_light, vec3 axis) {
  return axis - dot(axis, to_light) * to_light;
}

// normal: of the surface that is lit.
Incident incident(int light, vec3 position, vec3 normal) {
  vec4 place = texelFetch(lights, ivec2(0, light), 0);
  vec4 strength = texelFetch(lights, ivec2(1, light), 0);
  vec4 axis = texelFetch(lights, ivec2(2, light), 0);
  vec4 u = texelFetch(lights, ivec2(3, light), 0);
#ifdef LIGHT_SET_TARGET
  strength.rgb *= dot(texelFetch(lights, ivec2(5, light), 0), light_set);
#endif
  Incident here;
  here.middle = place.xyz - position * place.w;
  float distance2 = max(dot(here.middle, here.middle), 1e-30);
  here.to_light = here.middle * inversesqrt(distance2);
  here.irradiance = strength.rgb / (place.w > 0.5 ? distance2 : 1.0);
  float along = -dot(here.to_light, axis.xyz);
  float open = clamp((along - axis.w) * u.w, 0.0, 1.0);
  here.irradiance *= open * open * (3.0 - 2.0 * open);
  float size2 = strength.w * strength.w / distance2;
  here.is_sized = size2 > LEAST_SIZE * LEAST_SIZE;
#ifdef SIZED_LIGHTS
  vec4 v = texelFetch(lights, ivec2(4, light), 0);
  vec3 spread = strength.rgb / (4.0 * strength.w * strength.w);
  if (v.w > 0.5) {
    here.irradiance *= max(along, 0.0);
    here.half_u = u.xyz;
    here.half_v = v.xyz;
    here.radiance = along > 0.0 ? spread : vec3(0.0);
  }
  else {
    here.half_u = facing_axis(here.to_light) * strength.w;
    here.half_v = cross(here.to_light, here.half_u);
    float rim = strength.w * inversesqrt(1.0 + strength.w * strength.w);
    // What a sun sends is given as irradiance.
    here.radiance = place.w > 0.5 ? spread * open * open * (3.0 - 2.0 * open)
                                  : strength.rgb / (4.0 * rim * atan(rim));
  }
#endif
#ifdef SHADOW_SHARE
  light_unshadowed += here.irradiance * max(dot(normal, here.to_light), 0.0);
#endif
#ifdef SHADOWS
  vec4 caster = texelFetch(lights, ivec2(6, light), 0);
  if (caster.y > 0.0 && dot(here.irradiance, vec3(1.0)) > 0.0) {
    vec3 half_u = vec3(0.0), half_v = vec3(0.0);
    if (caster.z > 0.0) {
      vec4 side = texelFetch(lights, ivec2(4, light), 0);
      bool is_flat = side.w > 0.5;
      half_u = is_flat ? ROUND * turned_to(here.to_light, u.xyz) : facing_axis(here.to_light) * caster.z;
      half_v = is_flat ? ROUND * turned_to(here.to_light, side.xyz) : cross(here.to_light, half_u);
    }
    float lit = lit_share(caster, half_u, half_v, position, normal);
    here.irradiance *= lit;
#ifdef SIZED_LIGHTS
    here.radiance *= lit;
#endif
  }
#endif
#ifdef SHADOW_SHARE
  light_arriving += here.irradiance * max(dot(normal, here.to_light), 0.0);
#endif
  return here;
}
