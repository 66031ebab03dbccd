// References: none needed.
// Summary: material (if polygons differ in it) and light set of the visible polygon. Hooks: `own` is what the corners
//          have, `looked_up` what images have in its place.

#part polygons.frag, materials
void materials_own(inout vec3 own) {
  own = material;
}

#part polygons.frag
vec3 polygon_own() {
  vec3 own = vec3(0.0);
  #hook own(own)
  #hook looked_up(own)
  return own;
}

void polygon_material_add() {
  polygon_material = vec4(polygon_own(), dot(instance.light_set, vec4(0.0, 1.0, 2.0, 3.0)));
}
