// References: none needed.
// Summary: a draw call of many objects; vertices tell fragments whose they are, and both look up its values.

#include "lib/instance_table.glsl"

#part vertex
bool is_beyond_instance() {
  return is_beyond;
}

int begun_vertex() {
  int number = instance_of_vertex(gl_VertexID);
  instance_number = float(number);
  return vertex_of_instance(gl_VertexID, number);
}

#part fragment
void begin_fragment() {
  instance = stored_instance(int(instance_number + 0.5));
}
