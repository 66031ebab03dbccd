// References: none needed.
// Summary: a fragment looks up the values of the object that visibility has noted.

#include "lib/instance_table.glsl"

bool is_beyond_instance() {
  return false;
}
