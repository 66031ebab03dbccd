// References: Burns, Hunt, "The Visibility Buffer: A Cache-Friendly Approach to Deferred Shading", JCGT 2013.
// Summary: adds the splat that visibility has noted to a sample's sums, if it is of the draw call's kind.

#include "lib/instances/{instances}.glsl"
#include "hosts/splat.glsl"
#include "hosts/splat_varyings.glsl"
#include "hosts/gbuffer.glsl"

// Depth of a splat's plane at a place in the picture; of its centre where rounding finds it beyond the splat.
float depth_on(Splat splat, vec2 place) {
  vec3 across = cross(splat.axis_u, splat.axis_v);
  bool is_orthographic = view.is_parallel > 0.5;
  float reach = length(vec2(splat.axis_u.z, splat.axis_v.z)), middle = -splat.position.z;
  float facing = is_orthographic ? across.z : dot(across, vec3(-place, 1.0));
  float before = is_orthographic ? dot(across.xy, place - splat.position.xy) : -dot(across, splat.position);
  float depth = before / facing + (is_orthographic ? middle : 0.0);
  return abs(depth - middle) <= reach ? depth : middle;
}

#parts
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  // What visibility sees below a sample that sees nothing has the colour of this sample (resolve.frag.glsl).
  int below = texelFetch(visibility_depth, texel, 0).r < 1.0 ? 0 : ROWS - 1;
  vec2 seen = texelFetch(nearest_splat, ivec2(texel.x, max(ROWS * texel.y - below, 0)), 0).xy;
  float index = seen.y - draw.first_noted;
  if (!(seen.x > 0.0 && index >= 0.0 && index < draw.stride)) discard;
  instance = stored_instance(int(seen.x) - 1);
  Splat splat = fetch_splat(int(index));
  normal = splat.normal;
  hand_on(splat, int(index));
  add_to_sums(splat.color, splat.side_weight, depth_on(splat, view.window.xy + gl_FragCoord.xy * view.window.zw));
}
