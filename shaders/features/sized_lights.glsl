// References: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016.
// Summary: lights with a size, as a square that faces the lit point, or that lies where an area light does.

#part lights
void sized_lights_spread(inout Incident here, LightTexels of, float along, float open) {
  vec4 v = texelFetch(lights, ivec2(4, of.number), 0);
  vec3 spread = of.strength.rgb / (4.0 * of.strength.w * of.strength.w);
  if (v.w > 0.5) {
    here.irradiance *= max(along, 0.0);
    here.half_u = of.u.xyz;
    here.half_v = v.xyz;
    here.radiance = along > 0.0 ? spread : vec3(0.0);
  }
  else {
    here.half_u = facing_axis(here.to_light) * of.strength.w;
    here.half_v = cross(here.to_light, here.half_u);
    float rim = of.strength.w * inversesqrt(1.0 + of.strength.w * of.strength.w);
    // The energy of a sun is given as irradiance.
    here.radiance = of.place.w > 0.5 ? spread * open * open * (3.0 - 2.0 * open)
                                     : of.strength.rgb / (4.0 * rim * atan(rim));
  }
}
