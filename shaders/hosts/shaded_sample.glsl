// References: Botsch et al. 2005, section 4 (normalise, then light once).
// Summary: turns a sample's sums into a lit surface; the includer has included a shading model. Hooks: `prepare` before
//          lighting, `restyle` after it, `outputs`, `finish`.

#include "hosts/outputs.glsl"
#include "hosts/mean_surface.glsl"
#include "lib/eye_position.glsl"

struct Shaded {
  MeanSurface mean;
  ivec2 texel;
  int tap;  // number of the texel's hardware sample, 0 if it has only one
  vec3 normal;
  vec3 material;
  vec3 color;      // what leaves it
  float coverage;  // below 1 only with an edge threshold or transparency
  Outputs outputs;
};

#parts
#include "lib/faces/{faces}.glsl"

// mean: a surface with coverage above 0.
Shaded shaded_sample(MeanSurface mean, ivec2 texel, int tap) {
  vec3 position = eye_position(texel, mean.depth);
  float size = length(mean.normal);
  vec3 normal = size > CANCELLED ? mean.normal / size : vec3(0.0, 0.0, 1.0);
  Shaded s = Shaded(mean, texel, tap, normal, frame.material.xyz, vec3(0.0), mean.coverage, NO_OUTPUTS);
  #hook prepare(s)
  s.color = lit(s, position);
  #hook restyle(s, position)
  s.outputs.diffuse_color = mean.color;
  #hook outputs(s)
  s.color += s.outputs.emission;
  #hook finish(s)
  return s;
}

#include "lib/polygon_light/{polygon_light}.glsl"
