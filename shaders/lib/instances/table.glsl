// References: none needed.
// Summary: a draw call of many objects; only the vertex stage needs their values.

#part vertex
#include "lib/instance_table.glsl"

bool is_beyond_instance() {
  return is_beyond;
}

int begun_vertex() {
  return vertex_of_instance(gl_VertexID, instance_of_vertex(gl_VertexID));
}

#part fragment
void begin_fragment() {}
