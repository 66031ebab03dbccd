// References: none needed.
// Summary: the picture of an empty world. Hook: `pixel` writes further outputs.

#include "hosts/outputs.glsl"
#include "lib/background/{background}.glsl"

#parts
void main() {
  vec4 total = vec4(0.0);
  for (int i = 0; i < SAMPLES * SAMPLES; i++) {
    total += world_background(ivec2(gl_FragCoord.xy) * SAMPLES + ivec2(i % SAMPLES, i / SAMPLES));
  }
  combined = total / float(SAMPLES * SAMPLES);
  depth = 1e10;
  #hook pixel()
  write_outputs(before_background(NO_OUTPUTS, 0.0));
}
