// References: as environment_image.glsl; rendering/scene/picture_sun.py, which makes a light of what is left out.
// Summary: the world image that lights surfaces, in a direction: without its sun.

#include "lib/environment_image.glsl"

vec3 lighting_picture_at(vec3 direction) {
  vec3 radiance = environment_image_at(direction);
  float brightest = max(max(radiance.r, radiance.g), radiance.b), limit = frame.picture_sun.w;
  bool is_sun = brightest > limit && dot(direction, frame.picture_sun.xyz) > SUN_REACH_COSINE * length(direction);
  return is_sun ? radiance * (limit / brightest) : radiance;
}
