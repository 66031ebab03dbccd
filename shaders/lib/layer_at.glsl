// References: none needed.
// Summary: the shaded sample of a transparent layer at a sample, premultiplied. The layer's rim may be visible although
//          the sample's centre does not see it; then the mean of neighbours that do is used. Compositing and peeling
//          both use this function, so that the shares in each sample sum to 1.

#include "hosts/sample_outputs.glsl"

vec4 layer_at(ivec2 home) {
  vec4 total = texelFetch(shaded, home, 0);
  if (total.w > 0.0) return total;
  ivec2 last = textureSize(shaded, 0) - 1;
  float count = 0.0;
  for (int y = -1; y <= 1; y++) {
    for (int x = -1; x <= 1; x++) {
      vec4 beside = texelFetch(shaded, clamp(home + ivec2(x, y), ivec2(0), last), 0);
      total += beside;
      count += beside.w > 0.0 ? 1.0 : 0.0;
    }
  }
  return total / max(count, 1.0);
}

Outputs layer_outputs_at(ivec2 home) {
  if (texelFetch(shaded, home, 0).w > 0.0) return sample_outputs(home);
  Outputs total = NO_OUTPUTS;
  ivec2 last = textureSize(shaded, 0) - 1;
  float count = 0.0;
  for (int y = -1; y <= 1; y++) {
    for (int x = -1; x <= 1; x++) {
      ivec2 beside = clamp(home + ivec2(x, y), ivec2(0), last);
      float is_there = texelFetch(shaded, beside, 0).w > 0.0 ? 1.0 : 0.0;
      total = added(total, sample_outputs(beside), is_there);
      count += is_there;
    }
  }
  return added(NO_OUTPUTS, total, 1.0 / max(count, 1.0));
}
