// References: Sloan, Martin, Gooch, Gooch, "The Lit Sphere", Graphics Interface 2001; Blender's Workbench engine (the
//             basis around the view ray, and the scale that keeps within the ball's rim).
// Summary: the colour of a ball in an image at the same normal, times the surface's own colour.

#include "lib/to_viewer.glsl"

vec3 matcap_at(vec2 place) {
  ivec2 size = textureSize(matcap, 0);
  vec2 at = clamp(place * vec2(size) - 0.5, vec2(0.0), vec2(size - 1));
  ivec2 low = ivec2(floor(at)), high = min(low + 1, size - 1);
  vec2 share = at - vec2(low);
  vec3 below = mix(texelFetch(matcap, low, 0).rgb, texelFetch(matcap, ivec2(high.x, low.y), 0).rgb, share.x);
  vec3 above = mix(texelFetch(matcap, ivec2(low.x, high.y), 0).rgb, texelFetch(matcap, high, 0).rgb, share.x);
  return mix(below, above, share.y);
}

vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  vec3 to_eye = to_viewer(position);
  float a = 1.0 / (1.0 + to_eye.z), b = -to_eye.x * to_eye.y * a;
  vec3 across = vec3(1.0 - to_eye.x * to_eye.x * a, b, -to_eye.x);
  vec3 up = vec3(b, 1.0 - to_eye.y * to_eye.y * a, -to_eye.y);
  return base * matcap_at(vec2(dot(across, normal), dot(up, normal)) * 0.496 + 0.5);
}
