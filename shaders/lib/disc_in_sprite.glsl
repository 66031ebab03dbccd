// References: Botsch, Kobbelt 2003, sections 3.1 and 3.2, equation 2.
// Summary: a disc in a sprite parallel to the picture: its plane's depth offset, linear over the sprite, bounds it.

const float LEAST_COSINE = 0.1;  // a disc seen flatter is drawn as one seen at this angle

// Depth offset towards the viewer of the disc's plane, from place to place in its sprite: both in radii.
vec2 sprite_tilt(vec3 axis_u, vec3 axis_v) {
  vec3 disc = normalize(cross(axis_u, axis_v));
  disc *= disc.z < 0.0 ? -1.0 : 1.0;
  return -disc.xy / max(disc.z, LEAST_COSINE);
}

// A place about the unit circle as one about the disc, which its tilt foreshortens: q^2 + (tilt q)^2 = 1.
vec2 disc_in_sprite(vec2 tilt, vec2 place) {
  float steepness = length(tilt);
  vec2 along = steepness > 0.0 ? tilt / steepness : vec2(1.0, 0.0);
  return mat2(along, -along.y, along.x) * vec2(place.x * inversesqrt(1.0 + steepness * steepness), place.y);
}

// Whether a place in the sprite, in radii, is in the disc.
bool is_in_disc(vec2 place, vec2 tilt) {
  float offset = dot(tilt, place);
  return dot(place, place) + offset * offset <= 1.0;
}
