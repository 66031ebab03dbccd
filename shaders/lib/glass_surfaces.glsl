// References: Baldwin, Weber, "Fast Ray-Triangle Intersections by Coordinate Transformation", JCGT 2016; Laine, "Restart
//             Trail for Stackless BVH Traversal", HPG 2010 (bits that tell where a ray has been).
// Summary: what a ray meets of the surfaces of glass, and what it does there. The texture is that of
//          rendering/scene/glass_surfaces.py.

// Boxes and leaves that are looked at for one ray, at most: llvmpipe ends all loops of a shader after 65,535 turns.
const int GLASS_VISITS = 1500;
#include "lib/far.glsl"

// What a ray meets.
struct GlassMet {
  float away;  // FAR for nothing
  vec3 normal;
  vec3 tint;
  float ior;
  float roughness;
  bool casts;  // a shadow
};

float fresnel_of(float cosine, float ratio) {  // ratio: of the indices, behind the surface over before it
  float sine2 = (1.0 - cosine * cosine) / (ratio * ratio);
  if (sine2 >= 1.0) return 1.0;
  float behind = sqrt(1.0 - sine2);
  float across = (cosine - ratio * behind) / (cosine + ratio * behind);
  float along = (ratio * cosine - behind) / (ratio * cosine + behind);
  return 0.5 * (across * across + along * along);
}

// Behind a surface that faces the ray; along it where nothing is refracted.
vec3 bent(vec3 along, vec3 against, float cosine, float ratio) {
  float square = 1.0 - (1.0 - cosine * cosine) / (ratio * ratio);
  return normalize(along / ratio + against * (cosine / ratio - sqrt(max(square, 0.0))));
}

// Where a block of four texels begins. Shifts, because drivers may divide integers one by one.
ivec2 pane_place(int block) {
  return ivec2((block & ((1 << GLASS_ROW_BITS) - 1)) << 2, block >> GLASS_ROW_BITS);
}

vec4 pane_texel(ivec2 place, int number) {
  return texelFetch(glass_surfaces, place + ivec2(number, 0), 0);
}

// Three numbers from -1 to 1, as bytes of one.
vec3 unpacked(float bytes) {
  vec2 rest = floor(bytes / vec2(256.0, 65536.0));
  return vec3(bytes - 256.0 * rest.x, rest.x - 256.0 * rest.y, rest.y) / 127.5 - 1.0;
}

// Where a ray enters a box, FAR if it does not before an end, or if nothing in it faces that way.
float enters_box(vec4 low, vec4 high, vec3 from, vec3 inverse, vec3 facing, float end) {
  vec3 one = (low.xyz - from) * inverse, other = (high.xyz - from) * inverse;
  vec3 first = min(one, other), last = max(one, other);
  float enters = max(max(first.x, first.y), max(first.z, 0.0)), leaves = min(min(last.x, last.y), last.z);
  bool faces = dot(max(unpacked(low.w) * facing, unpacked(high.w) * facing), vec3(1.0)) > 0.0;
  return faces && low.x <= high.x && enters <= leaves * 1.00001 + 1e-6 && enters <= end ? enters : FAR;
}

// Up to the nearest node whose sibling is still to be looked at, and on to that; 0 behind the last.
void next_pane(inout int node, inout int waiting) {
  int up = (floatBitsToInt(float(waiting & -waiting)) >> 23) - 127;  // the lowest bit is a power of two, and so exact
  node = waiting == 0 ? 0 : (node >> up) ^ 1;
  waiting = waiting == 0 ? 0 : (waiting >> up) ^ 1;
}

// What a ray meets first of what is on its side: 1 where it leaves glass, -1 where it enters. Of discs that overlap the
// nearest counts, and the others by how near they are to their middles.
GlassMet met_glass(vec3 from, vec3 along, float side) {
  vec3 inverse = 1.0 / mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20))), normals = vec3(0.0);
  vec3 facing = along * side;
  // bits of `waiting` tell for the node and those above it whether their siblings are still to be looked at
  int leaves = int(frame.glass_leaves), node = 1, waiting = 0, nearest = -1;
  int visits = 0;
  float away = FAR;
  vec2 place = vec2(0.0);
  while (node > 0 && visits < GLASS_VISITS) {
    for (; node > 0 && node < leaves && visits < GLASS_VISITS; visits++) {
      ivec2 boxes = pane_place(node);
      float left = enters_box(pane_texel(boxes, 0), pane_texel(boxes, 1), from, inverse, facing, away);
      float right = enters_box(pane_texel(boxes, 2), pane_texel(boxes, 3), from, inverse, facing, away);
      if (min(left, right) < FAR) {
        node = 2 * node + int(right < left);
        waiting = 2 * waiting + int(max(left, right) < FAR);
      } else {
        next_pane(node, waiting);
      }
    }
    if (node < leaves) break;
    int first = leaves + (node - leaves) * GLASS_LEAF, last = first + GLASS_LEAF;
    for (int block = first; block < last; block++) {
      ivec2 at = pane_place(block);
      vec4 plane = pane_texel(at, 0);
      float turned = dot(plane.xyz, along), distance = -(dot(plane.xyz, from) + plane.w) / turned;
      if (!(turned * side > 0.0 && distance > 0.0 && distance < FAR)) continue;
      vec4 across = pane_texel(at, 1), up = pane_texel(at, 2);
      vec3 meets = from + along * distance;
      vec2 here = vec2(dot(across.xyz, meets) + across.w, dot(up.xyz, meets) + up.w);
      if (!(max(abs(here.x), abs(here.y)) <= 1.0)) continue;
      vec4 normal = pane_texel(at, 3);  // with half the length of a disc's half-axis; 0 for a triangle
      float weight = min(min(here.x, here.y), 1.0 - here.x - here.y) + 1e-5;
      if (normal.w > 0.0) weight = 1.0 - dot(here, here);
      if (!(weight >= 0.0) || distance > away + normal.w) continue;
      if (distance < away - normal.w) normals = vec3(0.0);
      normals += normal.xyz * weight;
      if (distance < away) {
        away = distance;
        nearest = block;
        place = here;
      }
    }
    next_pane(node, waiting);
    visits++;
  }
  GlassMet met = GlassMet(away, normals, vec3(1.0), 1.0, 0.0, false);
  if (nearest < 0) return met;
  ivec2 more = pane_place(nearest + leaves * GLASS_LEAF);
  vec4 first = pane_texel(pane_place(nearest), 3), second = pane_texel(more, 0), third = pane_texel(more, 1);
  if (!(first.w > 0.0)) met.normal = mix(first.xyz, second.xyz, place.x) + (third.xyz - first.xyz) * place.y;
  met.ior = second.w;
  met.roughness = third.w;
  vec4 tint = pane_texel(more, 2);
  met.tint = tint.xyz;
  met.casts = tint.w > 0.0;
  return met;
}
