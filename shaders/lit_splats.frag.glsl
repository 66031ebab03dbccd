// References: Guennebaud, Barthe, Paulin 2006, section 6 (lighting for each splat in the last layer).
// Summary: lights each splat of an instance where it stands, at the texel of its number.

#define PARALLEL (shading.options.x > 0.5)
#define splats shading
vec3 material;
vec3 emission;
#include "common/splat_attributes.glsl"
#ifdef WITH_MATERIALS
#include "common/splat_material.glsl"
#endif
#include "shading/{shading}.glsl"

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int index = texel.y * SPLATS_PER_ROW + texel.x;
  Splat splat = fetch_splat(index);
  material = shading.material.xyz;
  emission = vec3(0.0);
#ifdef EMISSION
  emission = shading.emission.rgb;
#endif
#ifdef WITH_MATERIALS
  fetch_material(index, splat.material);
#endif
#ifdef LIGHT_SET_TARGET
  light_set = shading.light_set;
#endif
#ifdef SHADOWS
  shadow_turn = 0.125 + 0.25 * float(index & 3);
  shadow_plane = vec3(0.0);
#endif
#ifdef SHADOW_SHARE
  light_arriving = light_unshadowed = vec3(0.0);
#endif
  lit_splats = vec4(shade(splat.position, splat.normal, splat.color_weight.rgb, material) + emission, 1.0);
}
