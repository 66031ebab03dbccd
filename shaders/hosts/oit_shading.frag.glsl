// References: Guennebaud, Barthe, Paulin 2006, section 6 (colours of what is left, weighted by opacity); McGuire, Bavoil,
//             "Weighted Blended Order-Independent Transparency", JCGT 2013 (how much is hidden needs no order).
// Summary: everything behind the layers as one layer, premultiplied. Each surface transmits the share 1 - opacity, so
//          logarithms add up. The number of surfaces is the sum of weights relative to that of the nearer layer.

#include "sum_formats/{sum_format}.glsl"
#include "lib/front_weight.glsl"
#include "lib/rest_opacity/{rest_opacity}.glsl"

float front_weight_at(ivec2 texel) {
  return front_weight(texelFetch(gbuffer_depth, texel, 0).y);
}

// Weight of the splats in the previous layer; at its rim, where the weight falls off, that of neighbouring samples.
float surface_weight(ivec2 texel) {
  ivec2 last = textureSize(gbuffer_depth, 0) - 1;
  float own = front_weight_at(texel), most = own;
  for (int y = -1; y <= 1; y++) {
    for (int x = -1; x <= 1; x++) {
      most = max(most, front_weight_at(clamp(texel + ivec2(x, y), ivec2(0), last)));
    }
  }
  return own > 0.5 * most ? own : most;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 sum = texelFetch(oit_accum, texel, 0);
  vec2 weights = texelFetch(oit_weight, texel, 0).xy;
  shaded = vec4(0.0);
  if (sum.w > 0.0) {
    float hidden = rest_hidden(weights, sum.w, surface_weight(texel));
    shaded = vec4(sum.rgb / sum.w, 1.0) * hidden;
  }
}
