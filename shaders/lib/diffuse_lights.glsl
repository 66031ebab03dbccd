// References: Lambert 1760.
// Summary: the light that a matt white surface sends out under all lights.

#include "hosts/lights.glsl"

vec3 diffuse_light(vec3 position, vec3 normal) {
  vec3 sum = vec3(0.0);
  int count = int(frame.light_count);
  for (int i = 0; i < count; i++) {
    Incident light = incident(i, position, normal);
    sum += light.irradiance * max(dot(normal, light.to_light), 0.0) / PI;
  }
  return sum;
}
