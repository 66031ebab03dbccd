// References: none needed.
// Summary: identifies samples by the number of a splat's material slot among those of all instances, as in
//          rendering/identity.py; 0 means nothing.

#part vertex
float slot_number(float slot) {
  return instance.first_slot + min(slot, instance.more_slots);
}

#part splat_varyings
void object_id_tell(Splat splat, int index) {
  number = slot_number(splat.material);
}

#part corner
void object_id_tell(int corner, float slot, vec3 eye) {
  number = slot_number(slot);
}

#part visibility.frag
void object_id_add() {
  identity = vec2(number, place_depth.z);
}

#part point_sprite.frag
void object_id_add() {
  identity = vec2(number, tilt_depth.z);
}

#part polygons.frag
void object_id_add() {
  polygon_identity = vec2(number, depth_at);
}

#part screen_space.frag, edge_ids
// Write only the splat's number where nothing is visible.
void object_id_keep(inout Candidate c) {
  if (texelFetch(visibility_depth, ivec2(gl_FragCoord.xy), 0).r < 1.0) discard;
}

void object_id_add(Candidate c) {
  identity = vec2(number, c.depth);
}

#part object_space.frag, edge_ids
void object_id_keep() {
  if (texelFetch(visibility_depth, ivec2(gl_FragCoord.xy), 0).r < 1.0) discard;
}

#part gbuffer, edge_ids, in_space
void object_id_add(inout Fragment f) {
  identity = vec2(number, f.depth);
}

#part peel.frag
void object_id_start(ivec2 at) {
  identity_next = texelFetch(identity, at, 0).xy;
}

void object_id_peel(ivec2 at, bool is_surface, float before) {
  if (is_surface && before >= 0.0) identity_next = texelFetch(layer_identity, at, 0).xy;
}
