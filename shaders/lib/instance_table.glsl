// References: rendering/features/together.py, which writes this layout.
// Summary: the values of each of many objects of one draw call, in the order of the uniform block of a single one. Each
//          has as many triangles as the others, of which some may be beyond its own.

struct Instance {
  mat4 model_view;
  mat4 normal_matrix;
  vec4 light_set;
  float orientation;
  float hides_backs;
  float overlap;
  float first_slot;
  float more_slots;
  float split_distance;
  float first;  // triangle in textures that objects share
  float count;  // of its triangles, if it may have fewer than the others
};

Instance instance;

mat4 matrix_at(ivec2 at) {
  return mat4(texelFetch(instances, at, 0), texelFetch(instances, at + ivec2(1, 0), 0),
              texelFetch(instances, at + ivec2(2, 0), 0), texelFetch(instances, at + ivec2(3, 0), 0));
}

Instance stored_instance(int number) {
  ivec2 at = ivec2((number % INSTANCES_PER_ROW) * TEXELS_PER_INSTANCE, number / INSTANCES_PER_ROW);
  Instance stored;
  stored.model_view = matrix_at(at);
  stored.normal_matrix = matrix_at(at + ivec2(4, 0));
  stored.light_set = texelFetch(instances, at + ivec2(8, 0), 0);
  vec4 single = texelFetch(instances, at + ivec2(9, 0), 0), more = texelFetch(instances, at + ivec2(10, 0), 0);
  stored.orientation = single.x;
  stored.hides_backs = single.y;
  stored.overlap = single.z;
  stored.first_slot = single.w;
  stored.more_slots = more.x;
  stored.split_distance = more.y;
  stored.first = more.z;
  stored.count = more.w;
  return stored;
}

#part vertex
int instance_of_vertex(int vertex) {
  return int(draw.first_instance) + vertex / (3 * int(draw.stride));
}

bool is_beyond;  // the object's own triangles

// The vertex of an object that stands for one of the draw call, after its values were looked up.
int vertex_of_instance(int vertex, int number) {
  instance = stored_instance(number);
  int within = vertex % (3 * int(draw.stride)), triangle = min(within / 3, int(instance.count) - 1);
  is_beyond = triangle < within / 3;
  return 3 * (int(draw.first) + int(instance.first) + triangle) + within % 3;
}
