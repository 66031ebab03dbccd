// References: lib/screen_door.glsl.
// Summary: transparent splats leave gaps in a shadow map in proportion to the light they let through.

#part splat_varyings
void transparent_shadows_tell(Splat splat, int index) {
  opacity_surface = vec2(splat.opacity, 2.0 * instance.first_slot + (splat.is_back ? 1.0 : 0.0));
}

#part visibility.frag
#include "lib/screen_door.glsl"

void transparent_shadows_keep() {
  if (!is_kept(opacity_surface.x, int(opacity_surface.y + 0.5), ivec2(gl_FragCoord.xy))) discard;
}
