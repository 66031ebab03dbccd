// References: none needed.
// Summary: the depth of what each sample sees, 0 where it sees nothing: looked at often, it is kept in one number.

#include "hosts/mean_surface.glsl"

#parts
void main() {
  MeanSurface mean = mean_surface(ivec2(gl_FragCoord.xy), 0);
  occluders = mean.coverage > 0.0 ? mean.depth : 0.0;
}
