// References: Botsch, Kobbelt 2003, sections 3.1 and 3.2, equation 2.
// Summary: a disc in a sprite parallel to the picture, bounded by the depth offset of its plane, which is linear over
//          the sprite.

const float LEAST_COSINE = 0.1;  // discs at more grazing angles are drawn as at this angle

// Depth offset of the disc's plane towards the viewer, at a point of its sprite; both in radii.
vec2 sprite_tilt(vec3 axis_u, vec3 axis_v) {
  vec3 disc = normalize(cross(axis_u, axis_v));
  disc *= disc.z < 0.0 ? -1.0 : 1.0;
  return -disc.xy / max(disc.z, LEAST_COSINE);
}

// Maps a point around the unit circle to one around the disc, which its tilt foreshortens: q^2 + (tilt q)^2 = 1.
vec2 disc_in_sprite(vec2 tilt, vec2 place) {
  float steepness = length(tilt);
  vec2 along = steepness > 0.0 ? tilt / steepness : vec2(1.0, 0.0);
  return mat2(along, -along.y, along.x) * vec2(place.x * inversesqrt(1.0 + steepness * steepness), place.y);
}

// Whether a point of the sprite, in radii, is in the disc.
bool is_in_disc(vec2 place, vec2 tilt) {
  float offset = dot(tilt, place);
  return dot(place, place) + offset * offset <= 1.0;
}
