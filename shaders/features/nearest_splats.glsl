// References: Burns, Hunt, "The Visibility Buffer: A Cache-Friendly Approach to Deferred Shading", JCGT 2013.
// Summary: notes the object and the splat that visibility sees.

#part splat_varyings, notes
void nearest_splats_tell(Splat splat, int index) {
  bool is_noted = draw.first_noted >= 0.0;
  told_splat = is_noted ? vec2(instance.normal_matrix[3].x + 1.0, draw.first_noted + float(index)) : vec2(0.0);
}

#part corner
void nearest_splats_tell(int corner, float slot, vec3 eye) {
  told_splat = vec2(0.0);
}

#part visibility.frag
void nearest_splats_add() {
  nearest_splat = told_splat;
}
