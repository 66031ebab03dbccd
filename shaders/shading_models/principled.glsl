// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (GGX);
//             Heitz, "Understanding the Masking-Shadowing Function", 2014, equation 99 (height-correlated Smith);
//             Schlick 1994 (Fresnel); Heitz et al. 2016 (lights with a size); Kutz, Hasan, Edmondson, "Novel aspects of
//             the Adobe Standard Material", 2021 (a metal's tint, F82); Cycles' Principled BSDF (what a coat lets
//             through: what it does not reflect, tinted by Beer's law along the refracted way to the viewer).
// Summary: a surface like Principled: metal, or a dielectric over a Lambertian base that loses what the dielectric
//          reflects, under lights and the world. The twin of reference/shading.py.

#include "lib/brdf.glsl"
#include "lib/tangent_frame.glsl"
#include "lib/to_viewer.glsl"
#include "hosts/world_light.glsl"

const float LEAST_ROUGHNESS = 0.03;
const float MIN_COSINE = 1e-4;
// A mirror: what is less rough reflects lights that have a size, and no others, as in Cycles.
const float MIRROR_ROUGHNESS = 0.0038;
// A dielectric with almost no reflectance at normal incidence is effectively absent, and does not reflect at grazing
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
  vec3 scattered;  // factor for multiple scattering
  vec3 edge;  // what a metal's tint takes off its reflectance, times c (1 - c)^6
};

#parts
// material: roughness, metallic, reflectance at normal incidence
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  Lobe lobe;
  lobe.normal = normal;
  lobe.to_viewer = to_viewer(position);
  lobe.roughness = clamp(material.x, LEAST_ROUGHNESS, 1.0);
  lobe.nv = max(dot(normal, lobe.to_viewer), MIN_COSINE);
  float metallic = clamp(material.y, 0.0, 1.0);
  vec3 dielectric = vec3(material.z);
  #hook reflect(dielectric)
  lobe.f0 = mix(dielectric, base, metallic);
  float dielectric_f90 = min(GRAZING_GAIN * material.z, 1.0);
  lobe.f90 = mix(dielectric_f90, 1.0, metallic);
  vec4 terms_mean = table_at(lobe.roughness, lobe.nv, 1);
  vec2 terms = terms_mean.xy;
  vec3 scattered;
  vec3 lost = specular_albedo(terms, dielectric, dielectric_f90, scattered);
  #hook lose(lost)
  lobe.diffuse_albedo = base * (1.0 - metallic) * (1.0 - lost);
  lobe.specular_albedo = specular_albedo(terms, lobe.f0, lobe.f90, lobe.scattered);
  #hook dim(lobe, base, metallic)
  if (material.x < MIRROR_ROUGHNESS) lobe.scattered = vec3(0.0);
  #hook cover(lobe)
  vec3 reflected = mean_direction(terms_mean.zw, lobe.to_viewer, normal);
  vec3 radiance = lobe.diffuse_albedo * world_irradiance(normal)
      + lobe.specular_albedo * world_reflection(reflected, lobe.roughness);
  #hook mirror(radiance)
  #hook lit(radiance, lobe, position, normal)
  return radiance;
}

#part finish
#include "lib/finish.glsl"

#part specular_tint
// It is the reflectance at a cosine of 1 / 7, 82 degrees, as a share of what Schlick's formula has there.
const float EDGE_SCHLICK = 0.462664366;  // (6 / 7)^5
const float EDGE_GAIN = 17.6513846;  // 1 / (1 / 7 (6 / 7)^6)

void specular_tint_reflect(inout vec3 dielectric) {
  dielectric = min(dielectric * finish_numbers(0).rgb, vec3(1.0));
}

// The base loses as much of each colour as of the one that is reflected most.
void specular_tint_lose(inout vec3 lost) {
  lost = vec3(max(max(lost.r, lost.g), lost.b));
}

void specular_tint_dim(inout Lobe lobe, vec3 base, float metallic) {
  vec3 taken = 1.0 - min(finish_numbers(0).rgb, vec3(1.0));
  lobe.edge = metallic * EDGE_GAIN * mix(base, vec3(1.0), EDGE_SCHLICK) * taken;
  lobe.specular_albedo -= lobe.edge * edge_at(lobe.roughness, lobe.nv) * lobe.scattered;
}

#part covered
vec3 passed_on;  // share of the light from below what covers the surface

void covered_cover(inout Lobe lobe) {
  passed_on = vec3(1.0);
}

void cover(inout Lobe lobe, vec3 share) {
  passed_on *= share;
  lobe.diffuse_albedo *= share;
  lobe.specular_albedo *= share;
  lobe.scattered *= share;
}

#part sheen
#include "lib/sheen.glsl"

vec3 sheen_reflected;  // albedo
vec3 sheen_direction;  // mean of what it reflects
mat3 sheen_to_cosine;  // from eye space
float sheen_scale;

void sheen_cover(inout Lobe lobe) {
  vec4 color_roughness = finish_numbers(3);
  float roughness = clamp(color_roughness.a, 0.01, 1.0);
  mat3 to_tangent = tangent_frame(lobe.normal, lobe.to_viewer);
  vec2 bend = sheen_transform(lobe.nv, roughness);
  sheen_scale = bend.x;
  sheen_to_cosine = mat3(bend.x, 0.0, 0.0, 0.0, bend.x, 0.0, bend.y, 0.0, 1.0) * to_tangent;
  sheen_direction = normalize(vec3(-bend.y / bend.x, 0.0, 1.0) * to_tangent);
  sheen_reflected = color_roughness.rgb * sheen_albedo(lobe.nv, roughness);
  cover(lobe, vec3(max(1.0 - max(max(sheen_reflected.r, sheen_reflected.g), sheen_reflected.b), 0.0)));
}

void sheen_mirror(inout vec3 radiance) {
  radiance += sheen_reflected * world_irradiance(sheen_direction);
}

#part coat
Lobe coat;  // a dielectric without a base

void coat_cover(inout Lobe lobe) {
  vec4 tint_roughness = finish_numbers(1);
  float weight = min(finish_numbers(0).a, 1.0), ior = max(finish_numbers(2).x, 1.0);
  float root = (ior - 1.0) / (ior + 1.0), f0 = root * root;
  coat = lobe;
  coat.roughness = clamp(tint_roughness.a, LEAST_ROUGHNESS, 1.0);
  coat.f0 = vec3(f0);
  coat.f90 = min(GRAZING_GAIN * f0, 1.0);
  coat.diffuse_albedo = coat.edge = vec3(0.0);
  coat.specular_albedo = specular_albedo(table_at(coat.roughness, coat.nv, 1).xy, coat.f0, coat.f90, coat.scattered);
  vec3 passed = 1.0 - weight * coat.specular_albedo;
  coat.specular_albedo *= weight * passed_on;
  coat.scattered *= tint_roughness.a < MIRROR_ROUGHNESS ? vec3(0.0) : weight * passed_on;
  float refracted = sqrt(1.0 - (1.0 - coat.nv * coat.nv) / (ior * ior));  // cosine, of which the way is the inverse
  cover(lobe, passed * mix(vec3(1.0), pow(tint_roughness.rgb, vec3(1.0 / refracted)), weight));
}

void coat_mirror(inout vec3 radiance) {
  vec3 reflected = mean_direction(table_at(coat.roughness, coat.nv, 1).zw, coat.to_viewer, coat.normal);
  radiance += coat.specular_albedo * world_reflection(reflected, coat.roughness);
}

#part translucency
vec3 sent_on;  // albedo of what leaves on the other side
vec3 lit_normal;

void translucency_dim(inout Lobe lobe, vec3 base, float metallic) {
  float share = finish_numbers(2).w;
  sent_on = lobe.diffuse_albedo * share;
  lobe.diffuse_albedo *= 1.0 - share;
  lit_normal = lobe.normal;
}

void translucency_mirror(inout vec3 radiance) {
  radiance += sent_on * world_behind(lit_normal);
}

#part translucency, covered
void translucency_cover(inout Lobe lobe) {
  sent_on *= passed_on;
}

#part specular_tint, lights
void specular_tint_edge(inout vec3 fresnel, Lobe lobe, float vh) {
  fresnel -= lobe.edge * vh * pow(1.0 - vh, 6.0);
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
  vec3 fresnel = lobe.f0 + (lobe.f90 - lobe.f0) * pow(1.0 - vh, 5.0);
  #hook edge(fresnel, lobe, vh)
  fresnel *= lobe.scattered;
  return (lobe.diffuse_albedo / PI + distribution * masking * fresnel) * irradiance * nl;
}

#part lights, sized_lights
vec3 from_quad(Lobe lobe, Incident light) {
  mat3 to_tangent = tangent_frame(lobe.normal, lobe.to_viewer);
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
void add_light(inout vec3 radiance, Lobe lobe, Incident light) {
  bool is_done = false;
  #hook sent(radiance, is_done, lobe, light)
  if (!is_done) radiance += from_point(lobe, light.to_light, light.irradiance);
}

#part sheen, lights, sized_lights
void sheen_brushed(inout vec3 radiance, inout bool is_done, Incident light) {
  if (!light.is_sized) return;
  float share = form_factor(sheen_to_cosine * light.middle, sheen_to_cosine * light.half_u, sheen_to_cosine * light.half_v);
  radiance += light.radiance * sheen_reflected * share;
  is_done = true;
}

#part sheen, lights
void sheen_over(inout vec3 radiance, Incident light) {
  bool is_done = false;
  #hook brushed(radiance, is_done, light)
  vec3 bent = sheen_to_cosine * light.to_light;
  if (is_done || !(bent.z > 0.0)) return;
  float ratio = sheen_scale / max(dot(bent, bent), 1e-30);
  radiance += sheen_reflected * light.irradiance * (bent.z / PI * ratio * ratio);
}

#part coat, lights
void coat_over(inout vec3 radiance, Incident light) {
  add_light(radiance, coat, light);
}

#part lights
void lights_lit(inout vec3 radiance, Lobe lobe, vec3 position, vec3 normal) {
  int count = int(frame.light_count);
  for (int i = 0; i < count; i++) {
    Incident light = incident(i, position, normal);
    add_light(radiance, lobe, light);
    #hook over(radiance, light)
  }
}

#part translucency, lights, shadows
void translucency_turned() {
  shadow_plane = -shadow_plane;
}

#part translucency, lights
// The other side, without what it reflects.
void translucency_lit(inout vec3 radiance, Lobe lobe, vec3 position, vec3 normal) {
  Lobe other = lobe;
  other.normal = -normal;
  other.diffuse_albedo = sent_on;
  other.specular_albedo = other.scattered = other.f0 = other.edge = vec3(0.0);
  other.f90 = 0.0;
  #hook turned()
  int count = int(frame.light_count);
  for (int i = 0; i < count; i++) {
    Incident light = incident(i, position, -normal);
    add_light(radiance, other, light);
  }
  #hook turned()
}
