// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (GGX);
//             Heitz, "Understanding the Masking-Shadowing Function", 2014, equation 99 (height-correlated Smith);
//             Schlick 1994 (Fresnel); Karis, "Physically Based Shading on Mobile", 2014 (environment BRDF).
// Summary: a Principled-like surface: metal or a dielectric coat over a Lambertian base that loses what the coat
//          reflects; suns, points and an even world. The twin of reference/shading.py.

const float PI = 3.14159265358979;
const float MIN_ROUGHNESS = 0.03;
const float MIN_COSINE = 1e-4;

// material: roughness, metallic, reflectance at normal incidence
vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  vec3 view = shading.options.x > 0.5 ? vec3(0.0, 0.0, 1.0) : -normalize(position);
  float roughness = clamp(material.x, MIN_ROUGHNESS, 1.0);
  float metallic = clamp(material.y, 0.0, 1.0);
  vec3 f0 = mix(vec3(material.z), base, metallic);
  float nv = max(dot(normal, view), MIN_COSINE);

  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a004 = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
  vec2 ab = vec2(-1.04, 1.04) * a004 + r.zw;
  vec3 diffuse_albedo = base * (1.0 - metallic) * (1.0 - (material.z * ab.x + ab.y));
  vec3 radiance = shading.world.rgb * (diffuse_albedo + f0 * ab.x + ab.y);

#ifdef LIGHTS
  float a2 = roughness * roughness * roughness * roughness;
  int count = int(shading.options.y);
  for (int i = 0; i < count; i++) {
    vec4 place = texelFetch(lights, ivec2(0, i), 0);
    vec3 irradiance = texelFetch(lights, ivec2(1, i), 0).rgb;
    vec3 to_light = place.xyz;
    if (place.w > 0.5) {
      to_light -= position;
      float distance2 = max(dot(to_light, to_light), 1e-30);
      irradiance /= distance2;
      to_light *= inversesqrt(distance2);
    }
    float nl = max(dot(normal, to_light), 0.0);
    if (nl > 0.0) {
      vec3 halfway = normalize(view + to_light);
      float nh = clamp(dot(normal, halfway), 0.0, 1.0);
      float vh = clamp(dot(view, halfway), 0.0, 1.0);
      vec3 sine = cross(normal, halfway);  // sin^2 + a^2 cos^2: 1 - cos^2 (1 - a^2) loses all digits on a mirror
      float d = dot(sine, sine) + nh * nh * a2;
      float distribution = a2 / (PI * d * d);
      float masking = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
      vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
      radiance += (diffuse_albedo / PI + distribution * masking * fresnel) * irradiance * nl;
    }
  }
#endif
  return radiance;
}
