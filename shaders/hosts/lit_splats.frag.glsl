// References: Guennebaud, Barthe, Paulin 2006, section 6 (lighting for each splat in the last layer).
// Summary: lights each splat of an instance at its own position, and writes it to the texel of its place among those
//          that are drawn. Hooks: `prepare` runs before lighting, `restyle` and `emit` after it.

vec3 material;
vec3 emission;
#include "lib/instances/{instances}.glsl"
#include "hosts/splat.glsl"
#include "shading_models/{shading}.glsl"

#parts
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int index = drawn_splat(texel.y * SPLATS_PER_ROW + texel.x);
  Splat splat = fetch_splat(index);
  material = frame.material.xyz;
  emission = vec3(0.0);
  #hook prepare(splat, index)
  vec3 radiance = shade(splat.position, splat.normal, splat.color, material);
  #hook restyle(radiance, splat, index)
  #hook emit(emission)
  lit_splats = vec4(radiance + emission, 1.0);
}
