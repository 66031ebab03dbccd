// References: none needed.
// Summary: a draw call of one object, whose values are in a uniform block.

bool is_beyond_instance() {
  return false;
}

#part vertex
int begun_vertex() {
  return gl_VertexID;
}

#part fragment
void begin_fragment() {}
