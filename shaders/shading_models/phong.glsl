// References: Blinn 1977; Akenine-Moeller, Haines, Hoffman, "Real-Time Rendering", 3rd edition, section 7.5.7 (its
//             factor (n + 8) / 8 pi, which keeps the energy).
// Summary: Lambert's diffuse light and Blinn's highlight, in the metal's colour or the reflectance; a uniform world.

#include "lib/half_vector.glsl"
#include "lib/to_viewer.glsl"
#include "hosts/world_light.glsl"

#parts
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  float metallic = clamp(material.y, 0.0, 1.0);
  vec3 diffuse = base * (1.0 - metallic), specular = mix(vec3(material.z), base, metallic);
  vec3 radiance = (diffuse + specular) * world_irradiance(normal);
  #hook lit(radiance, position, normal, diffuse, specular, material)
  return radiance;
}

#part lights
#include "hosts/lights.glsl"

void lights_lit(inout vec3 radiance, vec3 position, vec3 normal, vec3 diffuse, vec3 specular, vec3 material) {
  float exponent = blinn_exponent(material.x);
  vec3 to_eye = to_viewer(position);
  float factor = (exponent + 8.0) / (8.0 * PI);
  int count = int(frame.light_count);
  for (int i = 0; i < count; i++) {
    Incident light = incident(i, position, normal);
    float cosine = max(dot(normal, light.to_light), 0.0);
    if (!(cosine > 0.0)) continue;
    float lobe = factor * blinn_lobe(normal, normalize(to_eye + light.to_light), exponent);
    radiance += (diffuse / PI + specular * lobe) * light.irradiance * cosine;
  }
}
