// References: Toksvig, "Mipmapping Normal Maps", 2005 (the length of a mean of normals tells how much they differ).
// Summary: where a crease runs through a sample, each of its two faces is lit with its own normal. The mean of their
//          normals lies on the line between them, and so do those of neighbouring samples, in which the faces have other
//          shares. This line meets the sphere of unit vectors in the two normals. Where a normal beside the crease is
//          neither of the two, the surface bends smoothly, and is lit with the mean. So is a limb, where the surface
//          ends on one side, or turns away, and its back is mixed in.

const float ONE_FACE = 0.99;   // squared length of a mean normal, at least, of a single face
const float NEAREST = 1.5;     // samples across the crease, at least
const float FACES_AWAY = 2.0;  // way across it, in half the way over which shares change
const vec2 MISSED = vec2(0.35, 0.7);  // distance from the normal found there, in half-chords: of a crease, of a bend

struct Faces {
  vec3 one;  // normals
  vec3 other;
  float share;  // of the first; 1 where there is a single face
};

MeanSurface surface_beside(ivec2 texel, int tap) {
  return mean_surface(clamp(texel, ivec2(0), SIZE_OF(gbuffer_normal) - 1), tap);
}

// The unit vector along which mean normals change here. way: in samples, across the crease, with the change a sample as
// its length.
vec3 change_of_normals(Shaded s, out vec2 way) {
  vec3 changes[4];
  vec3 total = vec3(0.0);
  for (int i = 0; i < 4; i++) {
    MeanSurface other = surface_beside(s.texel + (i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5)), s.tap);
    changes[i] = other.coverage > 0.0 ? other.normal - s.mean.normal : vec3(0.0);
    total += dot(changes[i], total) < 0.0 ? -changes[i] : changes[i];
  }
  vec3 along = total / max(length(total), 1e-30);
  way = 0.5 * vec2(dot(changes[1] - changes[0], along), dot(changes[3] - changes[2], along));
  return along;
}

// Whether this is the normal at the end of a way, 0 to 1; 0 if nothing is there. Depths do not tell: at a crease with a
// face at grazing incidence, the mean depth lies in neither face.
float is_found(vec3 normal, float half_chord, Shaded s, vec2 way) {
  MeanSurface other = surface_beside(s.texel + ivec2(round(way)), s.tap);
  float missed = length(other.normal - normal) / half_chord;
  return other.coverage > 0.0 ? 1.0 - smoothstep(MISSED.x, MISSED.y, missed) : 0.0;
}

Faces faces_of(Shaded s) {
  Faces single = Faces(s.normal, s.normal, 1.0);
  vec3 mean = s.mean.normal;
  float square = dot(mean, mean);
  if (square > ONE_FACE || square < CANCELLED * CANCELLED) return single;
  vec2 way;
  vec3 along = change_of_normals(s, way);
  float change = length(way), middle = -dot(mean, along), half_chord = sqrt(middle * middle + 1.0 - square);
  if (!(change > CANCELLED)) return single;
  way *= clamp(FACES_AWAY * half_chord / change, NEAREST, float(FOLD_REACH)) / change;
  vec3 one = mean + (middle + half_chord) * along, other = mean + (middle - half_chord) * along;
  float found = min(is_found(one, half_chord, s, way), is_found(other, half_chord, s, -way));
  if (!(found > 0.0)) return single;
  one = normalize(mix(s.normal, one, found));
  other = normalize(mix(s.normal, other, found));
  return Faces(one, other, 0.5 - 0.5 * middle / half_chord);
}

// In a loop, which is skipped where a branch may not be.
vec3 lit(Shaded s, vec3 position) {
  Faces faces = faces_of(s);
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < (faces.share < 1.0 ? 2 : 1); i++) {
    vec3 normal = i == 0 ? faces.one : faces.other;
    radiance += (i == 0 ? faces.share : 1.0 - faces.share) * shade(position, normal, s.mean.color, s.material);
  }
  return radiance;
}
