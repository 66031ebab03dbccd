// References: Jimenez, Wu, Pesce, Jarabo, "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016 (horizons
//             in slices, the inner integral, light that is reflected more than once);
//             Lagarde, de Rousiers, "Moving Frostbite to PBR", 2014, section 4.10.2 (reflections).
// Summary: the share of the world's light that other visible surfaces leave to a sample. Slices run along whole steps
//          of samples, so that every tap lies in the slice and a plane has its own horizon. The twin of
//          reference/ambient_occlusion.py.

#part world_light
float open_share = 1.0;  // of the half-space around the normal, cosine-weighted
float open_cosine = 1.0;  // cosine between the normal and the viewer
vec3 open_diffuse = vec3(1.0);  // incoming light, including what occluders reflect

void ambient_occlusion_diffuse(inout vec3 light) {
  light *= open_diffuse;
}

void ambient_occlusion_reflected(inout vec3 light, float roughness) {
  float power = exp2(-16.0 * roughness - 1.0);
  light *= clamp(pow(open_cosine + open_share, power) - 1.0 + open_share, 0.0, 1.0);
}

#part shaded_sample
#include "lib/to_viewer.glsl"

const int OCCLUSION_SLICES = 4;
// Minimum cosine to the viewer: a mean normal may face away although the surface is visible.
const float LEAST_OCCLUSION_FACING = 0.2;
const int OCCLUSION_STEPS = 8;

// Cosine between the direction to the viewer and the highest horizon along a direction, at least `lowest`. phase: of
// the steps, which grow with the distance. Occluders beyond half the distance fade out.
float horizon_cosine(ivec2 texel, vec3 position, vec3 to_eye, ivec2 along, float reach, float phase, float lowest) {
  uvec2 size = uvec2(textureSize(sample_depths, 0));
  float highest = lowest, most = reach / length(vec2(along));
  float per_distance = 2.0 / frame.occlusion_distance;
  int last = 0;
  for (int i = 0; i < OCCLUSION_STEPS; i++) {
    float share = (float(i) + phase) / float(OCCLUSION_STEPS);
    last = max(last + 1, int(share * share * most + 0.5));
    ivec2 at = texel + along * last;
    if (any(greaterThanEqual(uvec2(at), size))) break;  // a negative value is a large unsigned one
    float depth = texelFetch(sample_depths, at, 0).r;
    if (!(depth > 0.0)) continue;
    vec3 toward = eye_position(at, depth) - position;
    float square = max(dot(toward, toward), 1e-30), per_length = inversesqrt(square);
    float weight = clamp(2.0 - square * per_length * per_distance, 0.0, 1.0);
    highest = max(highest, mix(lowest, dot(toward, to_eye) * per_length, weight));
  }
  return min(highest, 1.0);
}

// Integral of the cosine to the normal times the sine, over an angle from the viewer given by its cosine, on the side
// where `normal.y` points: equation 7 times the normal's length, where half of 1 - cos 2a is 1 - cosine^2.
float arc(float cosine, vec2 normal) {
  float square = 1.0 - cosine * cosine;
  return 0.5 * (normal.x * square + normal.y * (acos(cosine) - cosine * sqrt(square)));
}

float open_share_at(ivec2 texel, vec3 position, vec3 normal, vec3 to_eye) {
  float per_sample = view.window.z * (view.is_parallel > 0.5 ? 1.0 : -position.z);
  float reach = min(frame.occlusion_distance / per_sample, frame.occlusion_reach);
  if (!(reach > 1.0)) return 1.0;
  // One of two sets of directions, 45 degrees apart on average, and one of four phases, in blocks of 4 x 4 samples.
  bool is_between = ((texel.x + texel.y) & 1) == 1;
  float phase = 0.25 + 0.25 * float(((texel.x >> 1) & 1) + 2 * ((texel.y >> 1) & 1));
  float open = 0.0, all = 0.0;
  for (int i = 0; i < OCCLUSION_SLICES; i++) {
    ivec2 straight = ivec2[4](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1))[i];
    ivec2 along = is_between ? ivec2[4](ivec2(2, 1), ivec2(1, 2), ivec2(-1, 2), ivec2(-2, 1))[i] : straight;
    vec3 across = vec3(vec2(along) * view.window.zw, 0.0);
    across = normalize(across - to_eye * dot(across, to_eye));
    vec2 own = vec2(max(dot(normal, to_eye), LEAST_OCCLUSION_FACING), dot(normal, across));  // the normal in the slice
    float lowest = own.y / length(own);
    open += arc(horizon_cosine(texel, position, to_eye, along, reach, phase, -lowest), own);
    open += arc(horizon_cosine(texel, position, to_eye, -along, reach, phase, lowest), vec2(own.x, -own.y));
    all += own.x + asin(lowest) * own.y;
  }
  return clamp(open / all, 0.0, 1.0);
}

void ambient_occlusion_prepare(inout Shaded s) {
  vec3 position = eye_position(s.texel, s.mean.depth);
  vec3 to_eye = to_viewer(position);
  open_share = open_share_at(s.texel, position, s.normal, to_eye);
  open_cosine = clamp(dot(s.normal, to_eye), 0.0, 1.0);
  vec3 albedo = clamp(s.mean.color, 0.0, 1.0);
  vec3 a = 2.0404 * albedo - 0.3324, b = 0.6417 - 4.7951 * albedo, c = 2.7552 * albedo + 0.6903;
  open_diffuse = max(vec3(open_share), ((a * open_share + b) * open_share + c) * open_share);
}
