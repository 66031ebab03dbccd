// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (GGX);
//             Heitz, "Understanding the Masking-Shadowing Function", 2014, equation 99 (height-correlated Smith);
//             Schlick 1994 (Fresnel); Heitz et al. 2016 (lights with a size).
// Summary: a surface like Principled: metal, or a dielectric coat over a Lambertian base that loses what the coat
//          reflects, under lights and the world. The twin of reference/shading.py.

#include "lib/brdf.glsl"
#include "hosts/world_light.glsl"

const float PI = 3.14159265358979;
const float LEAST_ROUGHNESS = 0.03;
const float MIN_COSINE = 1e-4;
// A coat with almost no reflectance at normal incidence is effectively absent, and does not reflect at grazing
// incidence as in Schlick's formula (Lagarde & de Rousiers, "Moving Frostbite to PBR", 2014, section 3.1.1).
const float GRAZING_GAIN = 50.0;

struct Lobe {
  vec3 normal;
  vec3 to_viewer;
  float nv;
  float roughness;
  vec3 diffuse_albedo;
  vec3 f0;  // reflectance at normal incidence
  float f90;  // at grazing incidence
  vec3 specular_albedo;
  vec3 scattered;  // factor for multiple scattering in the coat
};

#parts
// material: roughness, metallic, reflectance at normal incidence
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  Lobe lobe;
  lobe.normal = normal;
  lobe.to_viewer = view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : -normalize(position);
  lobe.roughness = clamp(material.x, LEAST_ROUGHNESS, 1.0);
  lobe.nv = max(dot(normal, lobe.to_viewer), MIN_COSINE);
  float metallic = clamp(material.y, 0.0, 1.0);
  lobe.f0 = mix(vec3(material.z), base, metallic);
  float coat_f90 = min(GRAZING_GAIN * material.z, 1.0);
  lobe.f90 = mix(coat_f90, 1.0, metallic);
  vec4 terms_mean = table_at(lobe.roughness, lobe.nv, 1);
  vec2 terms = terms_mean.xy;
  vec3 scattered;
  vec3 coat = specular_albedo(terms, vec3(material.z), coat_f90, scattered);
  lobe.diffuse_albedo = base * (1.0 - metallic) * (1.0 - coat);
  lobe.specular_albedo = specular_albedo(terms, lobe.f0, lobe.f90, lobe.scattered);
  vec3 reflected = mean_direction(terms_mean.zw, lobe.to_viewer, normal);
  vec3 radiance = lobe.diffuse_albedo * world_irradiance(normal)
      + lobe.specular_albedo * world_reflection(reflected, lobe.roughness);
  #hook lit(radiance, lobe, position, normal)
  return radiance;
}

#part lights
#include "hosts/lights.glsl"

vec3 from_point(Lobe lobe, vec3 to_light, vec3 irradiance) {
  float nl = max(dot(lobe.normal, to_light), 0.0);
  if (!(nl > 0.0)) return vec3(0.0);
  float a2 = lobe.roughness * lobe.roughness * lobe.roughness * lobe.roughness, nv = lobe.nv;
  vec3 halfway = normalize(lobe.to_viewer + to_light);
  float nh = clamp(dot(lobe.normal, halfway), 0.0, 1.0);
  float vh = clamp(dot(lobe.to_viewer, halfway), 0.0, 1.0);
  vec3 sine = cross(lobe.normal, halfway);  // sin^2 + a^2 cos^2: 1 - cos^2 (1 - a^2) loses all precision on a mirror
  float d = (nh > 0.0 ? dot(sine, sine) : 1.0) + nh * nh * a2;
  float distribution = a2 / (PI * d * d);
  float masking = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
  vec3 fresnel = (lobe.f0 + (lobe.f90 - lobe.f0) * pow(1.0 - vh, 5.0)) * lobe.scattered;
  return (lobe.diffuse_albedo / PI + distribution * masking * fresnel) * irradiance * nl;
}

#part lights, sized_lights
vec3 from_quad(Lobe lobe, Incident light) {
  vec3 across = normalize(lobe.to_viewer - lobe.normal * dot(lobe.to_viewer, lobe.normal) + vec3(1e-7, 2e-7, 0.0));
  mat3 to_tangent = transpose(mat3(across, cross(lobe.normal, across), lobe.normal));
  vec3 middle = to_tangent * light.middle, u = to_tangent * light.half_u, v = to_tangent * light.half_v;
  vec4 m = table_at(lobe.roughness, lobe.nv, 0);
  mat3 to_cosine = mat3(m.x, 0.0, m.z, 0.0, 1.0, 0.0, m.y, 0.0, m.w);
  float diffuse = form_factor(middle, u, v), specular = form_factor(to_cosine * middle, to_cosine * u, to_cosine * v);
  return light.radiance * (lobe.diffuse_albedo * diffuse + lobe.specular_albedo * specular);
}

void sized_lights_sent(inout vec3 radiance, inout bool is_done, Lobe lobe, Incident light) {
  if (!light.is_sized) return;
  radiance += from_quad(lobe, light);
  is_done = true;
}

#part lights
void lights_lit(inout vec3 radiance, Lobe lobe, vec3 position, vec3 normal) {
  int count = int(frame.light_count);
  for (int i = 0; i < count; i++) {
    Incident light = incident(i, position, normal);
    bool is_done = false;
    #hook sent(radiance, is_done, lobe, light)
    if (!is_done) radiance += from_point(lobe, light.to_light, light.irradiance);
  }
}
