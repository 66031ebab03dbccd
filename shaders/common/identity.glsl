// References: none needed.
// Summary: the number of a splat's material slot among those of all instances, rendering/identity.py's; 0 is nothing.

float splat_number(float slot) {
  return splats.identity.x + min(slot, splats.identity.y);
}
