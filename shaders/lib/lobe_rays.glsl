// References: Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018; Krivanek, Colbert, "Real-time Shading
//             with Filtered Importance Sampling", 2008 (as wide as a ray's share of the lobe); Roberts, "The Unreasonable
//             Effectiveness of Quasirandom Sequences", 2018.
// Summary: rays into a GGX lobe: successive ones fill it. Each is as wide as the share that it would have if it were the
//          last, and the first lies along the lobe's mean direction and is as wide as the lobe.

#include "lib/tangent_frame.glsl"

struct LobeRay {
  vec3 along;
  float width;  // radians
};

// The width that is looked up, over that of a ray's share.
const float LOBE_TEXEL = 0.7;

LobeRay lobe_ray(vec3 normal, vec3 to_eye, vec3 mean, float roughness, int number) {
  float alpha = roughness * roughness, spread = alpha * sqrt(float(number) / float(number + 1));
  vec2 place = fract(0.5 + float(number) * vec2(0.7548776662, 0.5698402910));
  mat3 to_tangent = tangent_frame(normal, to_eye);
  vec3 eye = to_tangent * to_eye;
  eye = normalize(vec3(eye.xy, max(eye.z, 1e-3)));
  vec3 up = normalize(vec3(spread * eye.xy, eye.z)), u = normalize(vec3(-up.y, up.x, 0.0) + vec3(1e-7, 0.0, 0.0));
  float radius = sqrt(place.x), turn = 6.28318530718 * place.y, side = 0.5 * (1.0 + up.z);
  vec2 disc = radius * vec2(cos(turn), sin(turn));
  disc.y = mix(sqrt(max(1.0 - disc.x * disc.x, 0.0)), disc.y, side);
  vec3 halfway = u * disc.x + cross(up, u) * disc.y + up * sqrt(max(1.0 - dot(disc, disc), 0.0));
  halfway = normalize(vec3(spread * halfway.xy, max(halfway.z, 1e-6)));
  vec3 along = reflect(-eye, halfway);
  float a2 = alpha * alpha, d = halfway.z * halfway.z * (a2 - 1.0) + 1.0;
  float density = a2 / (6.28318530718 * d * d * (eye.z + sqrt(a2 + (1.0 - a2) * eye.z * eye.z)));
  float width = LOBE_TEXEL * inversesqrt(float(number + 1) * density);
  along.z = abs(along.z);
  return LobeRay(number > 0 ? along * to_tangent : mean, min(width, 1.5));
}
