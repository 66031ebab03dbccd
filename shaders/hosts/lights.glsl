// References: Blender manual, "Light Objects" (units); Cycles' spot falloff (a smooth step between cosines).
// Summary: the light that reaches a point from each light: decodes the texels of rendering/scene/light.py to a
//          direction, an irradiance and, for a light with a size, four corners. A round light is a square of the same
//          area that faces the point, as Cycles does with a disc. Hooks: `receive` scales its strength for the surface,
//          `spread` makes the square of a light with a size, `reach` runs before shadows, `hide` computes shadows,
//          `arrive` runs after them.

const float PI = 3.14159265358979;

struct Incident {
  vec3 to_light;    // unit
  vec3 irradiance;  // of a surface that faces the light
  bool is_sized;
  vec3 middle;  // from the point to the light; below, half-axes of its square
  vec3 half_u;
  vec3 half_v;
  vec3 radiance;    // of the square
};

const float LEAST_SIZE = 2e-3;  // minimum half-side over distance; smaller lights are points

struct LightTexels {
  int number;
  vec4 place;
  vec4 strength;
  vec4 axis;
  vec4 u;
};

// Unit vector perpendicular to the direction to a light.
vec3 facing_axis(vec3 to_light) {
  return normalize(cross(abs(to_light.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), to_light));
}

#parts
// normal: of the lit surface.
Incident incident(int light, vec3 position, vec3 normal) {
  LightTexels of = LightTexels(light, texelFetch(lights, ivec2(0, light), 0), texelFetch(lights, ivec2(1, light), 0),
                               texelFetch(lights, ivec2(2, light), 0), texelFetch(lights, ivec2(3, light), 0));
  #hook receive(of)
  Incident here;
  here.half_u = here.half_v = here.radiance = vec3(0.0);
  here.middle = of.place.xyz - position * of.place.w;
  float distance2 = max(dot(here.middle, here.middle), 1e-30);
  here.to_light = here.middle * inversesqrt(distance2);
  here.irradiance = of.strength.rgb / (of.place.w > 0.5 ? distance2 : 1.0);
  float along = -dot(here.to_light, of.axis.xyz);
  float open = clamp((along - of.axis.w) * of.u.w, 0.0, 1.0);
  here.irradiance *= open * open * (3.0 - 2.0 * open);
  float size2 = of.strength.w * of.strength.w / distance2;
  here.is_sized = size2 > LEAST_SIZE * LEAST_SIZE;
  #hook spread(here, of, along, open)
  #hook reach(here, normal)
  #hook hide(here, of, position, normal)
  #hook arrive(here, normal)
  return here;
}
