// References: Guennebaud, Barthe, Paulin 2006, section 6; resolve.frag.glsl, whose filter this has.
// Summary: composites everything behind the transparent layers under them. Hook: `filter` of a sample.

#include "lib/peel_state.glsl"

#parts
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES;
  layers = vec4(0.0);
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) {
      ivec2 texel = first + ivec2(x, y);
      vec4 own = texelFetch(shaded, texel, 0), seen = own * let_through(texel);
      #hook filter(texel, own, seen)
      layers += seen;
    }
  }
  layers /= float(SAMPLES * SAMPLES);
}
