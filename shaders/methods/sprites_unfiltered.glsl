// References: Botsch, Kobbelt 2003, sections 3.1, 3.2 and 5 (the faster of two quality levels: size and shape of the
//             splats, neither blending nor a depth for each pixel).
// Summary: a disc in a sprite around its centre, bounded by the depth offset of its plane; its depth is the centre's.
//          The twin of reference/methods/sprites_unfiltered.py.

const float LEAST_COSINE = 0.1;  // a disc seen flatter is drawn as one seen at this angle

// Depth offset of the disc's plane from corner to corner of its sprite, in radii.
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
