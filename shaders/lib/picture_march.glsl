// References: McGuire, Mara, "Efficient GPU Screen-Space Ray Tracing", JCGT 2014 (steps that are even in the picture).
// Summary: where a ray meets what the camera sees, in a picture that was drawn before the frame, and what is seen there.
//          The texture is that of rendering/probes/screen.py.

#include "lib/far.glsl"
#include "lib/picture_maps.glsl"

vec4 picture_at(int number, vec2 place) {
  PictureTexels at = picture_texels(picture_map(ivec2(frame.screen_size), number), number, place);
  vec4 below = mix(texelFetch(screen_picture, at.low_high.xy, 0), texelFetch(screen_picture, at.low_high.zy, 0), at.share.x);
  vec4 above = mix(texelFetch(screen_picture, at.low_high.xw, 0), texelFetch(screen_picture, at.low_high.zw, 0), at.share.x);
  return mix(below, above, at.share.y);
}

// Depth of what is seen, view units; FAR for nothing.
float picture_depth_at(vec2 place) {
  ivec2 size = ivec2(frame.screen_size), texel = clamp(ivec2(floor(place)), ivec2(0), size - 1);
  float depth = texelFetch(screen_picture, texel + ivec2(0, size.y), 0).r;
  return depth > 0.0 ? depth * frame.screen_scale : FAR;
}

const int PICTURE_STEPS = 32, PICTURE_HALVINGS = 5;
const float PICTURE_STRIDE = 3.0;  // pixels of a step, at least
// How far behind what begins to hide it a ray may be and still meet it, as a share of the depth.
const float PICTURE_BEHIND = 0.05;
// How far behind it a ray may begin: things stand on a floor, whose depth is that of the middle of a pixel.
const float PICTURE_TOUCHES = 0.005;

// A stretch of a ray in the picture: places in pixels and depths' inverses at its ends, or depths of a parallel view.
struct PictureWay {
  vec3 start;
  vec3 end;
};

vec3 in_picture(vec3 position) {
  bool is_parallel = view.is_parallel > 0.5;
  vec2 seen = is_parallel ? position.xy : position.xy / -position.z;
  return vec3((seen - frame.screen_window.xy) * frame.screen_window.zw, is_parallel ? -position.z : -1.0 / position.z);
}

float way_depth(vec3 at) {
  return view.is_parallel > 0.5 ? at.z : 1.0 / max(at.z, 1.0 / FAR);
}

// from, along: view space, along in view units per unit. reach: FAR without an end.
PictureWay picture_way(vec3 from, vec3 along, float reach) {
  PictureWay way;
  way.start = in_picture(from);
  bool is_parallel = view.is_parallel > 0.5;
  if (!is_parallel && along.z > 0.0) reach = min(reach, 0.99 * -from.z / along.z);
  if (is_parallel && reach >= FAR) reach = 1e4 * frame.screen_size.x / frame.screen_window.z / length(along);
  if (reach < FAR) {
    way.end = in_picture(from + along * reach);
  } else {
    vec2 seen = along.z < 0.0 ? along.xy / -along.z : along.xy * 1e6;
    way.end = vec3((seen - frame.screen_window.xy) * frame.screen_window.zw, 0.0);
  }
  // no farther than the picture's edge
  vec2 change = way.end.xy - way.start.xy, room = mix(-way.start.xy, frame.screen_size - way.start.xy, step(0.0, change));
  vec2 shares = room / mix(change, vec2(1e-9), lessThan(abs(change), vec2(1e-9)));
  float share = clamp(min(abs(change.x) > 1e-9 ? shares.x : 1.0, abs(change.y) > 1e-9 ? shares.y : 1.0), 0.0, 1.0);
  way.end = mix(way.start, way.end, share);
  return way;
}

// Where a stretch of a ray meets what is in the picture: place in pixels, depth; whether it does. is_open: whether it
// ends before nothing.
bool met_in_picture(PictureWay way, out vec3 found, out bool is_open) {
  float pixels = length(way.end.xy - way.start.xy);
  int steps = int(clamp(ceil(pixels / PICTURE_STRIDE), 1.0, float(PICTURE_STEPS)));
  vec3 low = way.start;
  float seen = picture_depth_at(low.xy), before = way_depth(low) - seen;
  if (before < PICTURE_TOUCHES * seen) before = min(before, 0.0);
  for (int i = 1; i <= steps; i++) {
    vec3 high = mix(way.start, way.end, float(i) / float(steps));
    seen = picture_depth_at(high.xy);
    float after = way_depth(high) - seen;
    if (before <= 0.0 && after > 0.0) {
      vec3 near = low, far = high;
      for (int k = 0; k < PICTURE_HALVINGS; k++) {
        vec3 middle = 0.5 * (near + far);
        if (way_depth(middle) > picture_depth_at(middle.xy)) far = middle; else near = middle;
      }
      float depth = picture_depth_at(far.xy);
      if (way_depth(near) < depth * (1.0 + PICTURE_BEHIND)) {
        found = vec3(far.xy, depth);
        return true;
      }
    }
    low = high;
    before = after;
  }
  is_open = before <= 0.0;
  return false;
}

// texel: the width that is looked up, pixels.
vec4 picture_mapped_at(vec2 place, float texel) {
  float number = clamp(log2(max(texel, 1.0)), 0.0, float(PICTURE_MAPS - 1));
  int finer = int(number);
  vec4 seen = picture_at(finer, place);
  return number > float(finer) ? mix(seen, picture_at(finer + 1, place), number - float(finer)) : seen;
}
