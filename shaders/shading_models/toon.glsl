// References: Lake, Marshall, Harris, Blackstein, "Stylized Rendering Techniques for Scalable Real-Time 3D
//             Animation", NPAR 2000 (the cosine looked up in a few steps); Blinn 1977 (what the highlight is cut from).
// Summary: each light's cosine in even steps from 0 to 1, and a highlight where Blinn's lobe is above half, weaker on
//          rough materials. Number and softness of the steps are frame values.

#include "lib/half_vector.glsl"
#include "lib/to_viewer.glsl"
#include "hosts/world_light.glsl"

// 0 below 0 and 1 above 1; between them half way.
float soft_step(float x, float softness) {
  float t = softness > 0.0 ? clamp(x / softness + 0.5, 0.0, 1.0) : (x >= 0.0 ? 1.0 : 0.0);
  return t * t * (3.0 - 2.0 * t);
}

// Each edge is at a multiple of 1 / steps.
float ramp(float cosine, float steps, float softness) {
  float at = cosine * steps, edge = clamp(floor(at + 0.5), 1.0, steps - 1.0);
  return (edge - 1.0 + soft_step(at - edge, softness)) / (steps - 1.0);
}

#parts
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  vec3 radiance = base * world_irradiance(normal);
  #hook lit(radiance, position, normal, base, material)
  return radiance;
}

#part lights
#include "hosts/lights.glsl"

void lights_lit(inout vec3 radiance, vec3 position, vec3 normal, vec3 base, vec3 material) {
  float steps = frame.toon_steps, softness = frame.toon_softness;
  float exponent = blinn_exponent(material.x);
  vec3 to_eye = to_viewer(position);
  vec3 highlight = mix(vec3(1.0), base, clamp(material.y, 0.0, 1.0)) * (1.0 - clamp(material.x, 0.0, 1.0));
  int count = int(frame.light_count);
  for (int i = 0; i < count; i++) {
    Incident light = incident(i, position, normal);
    float cosine = dot(normal, light.to_light);
    if (!(cosine > 0.0)) continue;
    float lobe = blinn_lobe(normal, normalize(to_eye + light.to_light), exponent);
    vec3 seen = base * ramp(cosine, steps, softness) + highlight * soft_step(lobe - 0.5, softness);
    radiance += seen * light.irradiance / PI;
  }
}
