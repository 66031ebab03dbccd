// References: Jimenez, Wu, Pesce, Jarabo, "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016 (horizons
//             in slices, the inner integral, light that is reflected more than once);
//             Lagarde, de Rousiers, "Moving Frostbite to PBR", 2014, section 4.10.2 (reflections).
// Summary: which share of the world's light other surfaces of the picture leave to a sample. Slices lead along whole steps
//          of samples, so that what is looked at lies in the slice and a plane has its own horizon. The twin of
//          reference/ambient_occlusion.py.

#part world_light
float open_share = 1.0;           // of the half-space around the normal, weighted by the cosine
float open_cosine = 1.0;          // of the normal to the viewer
vec3 open_diffuse = vec3(1.0);    // what arrives, with what the surfaces in the way reflect

void ambient_occlusion_diffuse(inout vec3 light) {
  light *= open_diffuse;
}

void ambient_occlusion_reflected(inout vec3 light, float roughness) {
  float power = exp2(-16.0 * roughness - 1.0);
  light *= clamp(pow(open_cosine + open_share, power) - 1.0 + open_share, 0.0, 1.0);
}

#part shaded_sample
const int OCCLUSION_SLICES = 4;
// Least cosine to the viewer that a normal counts with: a mean of normals may face away, what is seen does not.
const float LEAST_OCCLUSION_FACING = 0.2;
const int OCCLUSION_STEPS = 8;

vec3 sample_place(ivec2 texel, float depth) {
  vec2 place = view.window.xy + (vec2(texel) + 0.5) * view.window.zw;
  return vec3(view.is_parallel > 0.5 ? place : place * depth, -depth);
}

// Cosine between the way to the viewer and the highest that is seen along a direction, no less than `lowest`.
// phase: of the steps, which are the longer the farther away they lead. What is beyond half the distance counts less.
float horizon_cosine(ivec2 texel, vec3 position, vec3 to_eye, ivec2 along, float reach, float phase, float lowest) {
  ivec2 size = textureSize(occluders, 0);
  float highest = lowest, most = reach / length(vec2(along));
  int last = 0;
  for (int i = 0; i < OCCLUSION_STEPS; i++) {
    float share = (float(i) + phase) / float(OCCLUSION_STEPS);
    last = max(last + 1, int(share * share * most + 0.5));
    ivec2 at = texel + along * last;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
    float depth = texelFetch(occluders, at, 0).r;
    if (!(depth > 0.0)) continue;
    vec3 toward = sample_place(at, depth) - position;
    float away = max(length(toward), 1e-30);
    float weight = clamp(2.0 - 2.0 * away / frame.occlusion_distance, 0.0, 1.0);
    highest = max(highest, mix(lowest, dot(toward, to_eye) / away, weight));
  }
  return min(highest, 1.0);
}

// Over an angle from the viewer, the integral of the cosine to the normal, which is `tilt` from the viewer, times the sine.
float arc(float angle, float tilt) {
  return 0.25 * (cos(tilt) - cos(2.0 * angle - tilt) + 2.0 * angle * sin(tilt));
}

float open_share_at(ivec2 texel, vec3 position, vec3 normal, vec3 to_eye) {
  float per_sample = view.window.z * (view.is_parallel > 0.5 ? 1.0 : -position.z);
  float reach = min(frame.occlusion_distance / per_sample, frame.occlusion_reach);
  if (!(reach > 1.0)) return 1.0;
  // One of two sets of directions 45 degrees apart on average, and one of four phases, in blocks of 4 x 4 samples.
  bool is_between = ((texel.x + texel.y) & 1) == 1;
  float phase = 0.25 + 0.25 * float(((texel.x >> 1) & 1) + 2 * ((texel.y >> 1) & 1));
  float open = 0.0, all = 0.0;
  for (int i = 0; i < OCCLUSION_SLICES; i++) {
    ivec2 straight = ivec2[4](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1))[i];
    ivec2 along = is_between ? ivec2[4](ivec2(2, 1), ivec2(1, 2), ivec2(-1, 2), ivec2(-2, 1))[i] : straight;
    vec3 across = vec3(vec2(along) * view.window.zw, 0.0);
    across = normalize(across - to_eye * dot(across, to_eye));
    vec2 own = vec2(max(dot(normal, to_eye), LEAST_OCCLUSION_FACING), dot(normal, across));  // the normal in the slice
    float size = length(own), tilt = atan(own.y, own.x), lowest = own.y / size;
    float after = acos(horizon_cosine(texel, position, to_eye, along, reach, phase, -lowest));
    float before = -acos(horizon_cosine(texel, position, to_eye, -along, reach, phase, lowest));
    open += size * (arc(before, tilt) + arc(after, tilt));
    all += own.x + tilt * own.y;
  }
  return clamp(open / all, 0.0, 1.0);
}

void ambient_occlusion_attributes(inout Shaded s) {
  vec3 position = sample_place(s.texel, s.mean.depth);
  vec3 to_eye = view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : -normalize(position);
  open_share = open_share_at(s.texel, position, s.normal, to_eye);
  open_cosine = clamp(dot(s.normal, to_eye), 0.0, 1.0);
  vec3 albedo = clamp(s.mean.color, 0.0, 1.0);
  vec3 a = 2.0404 * albedo - 0.3324, b = 0.6417 - 4.7951 * albedo, c = 2.7552 * albedo + 0.6903;
  open_diffuse = max(vec3(open_share), ((a * open_share + b) * open_share + c) * open_share);
}
