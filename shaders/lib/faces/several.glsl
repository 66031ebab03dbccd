// References: Toksvig, "Mipmapping Normal Maps", 2005 (the length of a mean of normals tells how much they differ).
// Summary: where a crease runs through a sample, each of its two faces is lit with its own normal. The mean of their
//          normals lies on the line between them, and so do those of neighbouring samples, in which the faces have other
//          shares. This line meets the sphere of unit vectors in the two normals. Where a normal beside the crease is
//          neither of the two, three faces may meet: their normals are seen around the sample, and the mean tells their
//          shares. Else the surface bends smoothly, and is lit with the mean. So is a limb, where the surface ends on
//          one side, or turns away, and its back is mixed in.

const float ONE_FACE = 0.99;   // squared length of a mean normal, at least, of a single face
const float NEAREST = 1.5;     // samples across the crease, at least
const float FACES_AWAY = 2.0;  // way across it, in half the way over which shares change
const vec2 MISSED = vec2(0.35, 0.7);  // distance from the normal found there, in half-chords: of a crease, of a bend
const int DIRECTIONS = 8;     // in which faces are looked for around a corner
const float APART = 0.3;       // volume of three faces' normals, at least, in which shares are sure
const vec2 OFF = vec2(0.07, 0.2);  // distance from the plane through them, in heights of the cap: of a corner, of a bend

struct Faces {
  mat3 normals;
  vec3 shares;  // of the first only where there is a single face
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

// How far the sample shows these two faces, 0 to 1.
float two_faces(Shaded s, out Faces faces) {
  vec3 mean = s.mean.normal;
  vec2 way;
  vec3 along = change_of_normals(s, way);
  float change = length(way), middle = -dot(mean, along);
  float half_chord = sqrt(middle * middle + 1.0 - dot(mean, mean));
  if (!(change > CANCELLED)) return 0.0;
  way *= clamp(FACES_AWAY * half_chord / change, NEAREST, float(FOLD_REACH)) / change;
  faces.normals = mat3(mean + (middle + half_chord) * along, mean + (middle - half_chord) * along, vec3(0.0));
  faces.shares = vec3(0.5 - 0.5 * middle / half_chord, 0.5 + 0.5 * middle / half_chord, 0.0);
  return min(is_found(faces.normals[0], half_chord, s, way), is_found(faces.normals[1], half_chord, s, -way));
}

// How far the sample shows these three faces, 0 to 1: those around it whose normals differ most, each seen alone.
float three_faces(Shaded s, out Faces faces) {
  vec3 around[DIRECTIONS];
  for (int i = 0; i < DIRECTIONS; i++) {
    float turn = 6.2831853 * float(i) / float(DIRECTIONS);
    ivec2 away = ivec2(round(float(FOLD_REACH) * vec2(cos(turn), sin(turn))));
    MeanSurface other = surface_beside(s.texel + away, s.tap);
    bool is_one = other.coverage > 0.0 && dot(other.normal, other.normal) > ONE_FACE;
    around[i] = is_one ? normalize(other.normal) : vec3(0.0);
  }
  for (int k = 0; k < 3; k++) {
    float most = -1.0;
    vec3 chosen = vec3(0.0);
    for (int i = 0; i < DIRECTIONS; i++) {
      vec3 n = around[i];
      float differs = k == 0 ? 1.0 - dot(n, s.mean.normal) : length(cross(faces.normals[0], n));
      if (k == 2) differs = abs(dot(cross(faces.normals[0], faces.normals[1]), n));
      if (differs > most && dot(n, n) > 0.0) {
        most = differs;
        chosen = n;
      }
    }
    faces.normals[k] = chosen;
  }
  if (!(abs(determinant(faces.normals)) > APART)) return 0.0;
  mat3 reciprocal = inverse(faces.normals);
  vec3 shares = reciprocal * s.mean.normal;
  // The sum of shares is 1 on the plane through the three normals, above which there is a cap of the sphere.
  float height = length(vec3(1.0) * reciprocal) - 1.0;
  float off = abs(shares.x + shares.y + shares.z - 1.0) + dot(max(-shares, 0.0), vec3(1.0));
  faces.shares = max(shares, 0.0);
  faces.shares /= faces.shares.x + faces.shares.y + faces.shares.z;
  return 1.0 - smoothstep(OFF.x, OFF.y, off / height);
}

Faces faces_of(Shaded s) {
  Faces faces = Faces(mat3(s.normal, s.normal, s.normal), vec3(1.0, 0.0, 0.0));
  float square = dot(s.mean.normal, s.mean.normal);
  if (square > ONE_FACE || square < CANCELLED * CANCELLED) return faces;
  Faces several = faces;
  float found = two_faces(s, several);
  if (found < 1.0) {
    Faces three = faces;
    float found_three = three_faces(s, three);
    if (found_three > found) {
      found = found_three;
      several = three;
    }
  }
  if (!(found > 0.0)) return faces;
  for (int i = 0; i < 3; i++) several.normals[i] = normalize(mix(s.normal, several.normals[i], found));
  return several;
}

// In a loop, which is skipped where a branch may not be.
vec3 lit(Shaded s, vec3 position) {
  Faces faces = faces_of(s);
  int count = faces.shares.z > 0.0 ? 3 : faces.shares.y > 0.0 ? 2 : 1;
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < count; i++) {
    radiance += faces.shares[i] * shade(position, faces.normals[i], s.mean.color, s.material);
  }
  return radiance;
}
