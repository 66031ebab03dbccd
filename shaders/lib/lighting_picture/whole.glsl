// References: as environment_image.glsl.
// Summary: the world image that lights surfaces, in a direction: as it is.

#include "lib/environment_image.glsl"

vec3 lighting_picture_at(vec3 direction) {
  return environment_image_at(direction);
}
