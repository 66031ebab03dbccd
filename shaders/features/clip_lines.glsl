// References: Zwicker, Rasanen, Botsch, Dachsbacher, Pauly, "Perspective Accurate Splatting", 2004; Botsch et al. 2005,
//             section 4 (splats clipped at lines in their plane); splat_addon/clip_lines.py, which says what is stored.
// Summary: splats that end at up to two lines before their ellipse does. A line is (direction, c) with direction . q +
//          c >= 0 in half-axes; two make a convex corner or, in the other order, a reflex one. A filter blurs this end
//          as it blurs the rim: the weight is the share of kernel times pixel filter on the kept side of the line.
//          Twins: reference/rays.py, reference/methods/clip_lines.py.

#part splat_varyings
const float TURN = 6.28318531 / 65536.0;  // of a stored direction
const float CUT = 1.0 / 16384.0;          // half-axes, of a stored cut
const vec3 NO_LINE = vec3(0.0, 0.0, 1.0);

vec3 unpacked_line(vec2 stored) {
  return stored.y > 0.0 ? vec3(cos(stored.x * TURN), sin(stored.x * TURN), 1.0 - stored.y * CUT) : NO_LINE;
}

void clip_lines_tell(Splat splat, int index) {
  int row = index / SPLATS_PER_ROW - (float(index) < draw.first_merged ? 0 : int(draw.rows_without_lines));
  vec4 stored = floor(texelFetch(clip_lines, ivec2(index % SPLATS_PER_ROW, row), 0) * 65535.0 + 0.5);
  clip_first = unpacked_line(stored.xy);
  clip_second = unpacked_line(stored.zw);
  // the axes of merged splats may have been shortened
  clip_first.xy *= splat.shortened;
  clip_second.xy *= splat.shortened;
  bool are_there = stored.y > 0.0 && stored.w > 0.0;
  clip_is_reflex = are_there && mod(stored.z - stored.x + 65536.0, 65536.0) > 32768.0 ? 1.0 : 0.0;
}

#part splat_varyings, of_sprites
#include "lib/line_in_picture.glsl"
void of_sprites_tell(Splat splat, int index) {
  Plane plane = splat_plane(splat.position, splat.axis_u, splat.axis_v, view.is_parallel > 0.5);
  clip_first = line_in_picture(clip_first, plane);
  clip_second = line_in_picture(clip_second, plane);
}

#part splat_varyings, blurs_lines
const float RIGHT_ANGLE = 1.57079633;
const float LEAST_WIDTH = 0.01;  // half-axes between two lines; narrower strips count as that wide

// Rows of samples between a splat's centre and a line, if samples have the default size. One that just fits counts in
// part, because positions are rounded.
float rows_before(float line) {
  float rows = max(line, 0.0) * SAMPLE_SIZE;
  return floor(rows) + max(10.0 * fract(rows) - 9.0, 0.0);
}

// A strip between two lines: how much they face each other, from 0 to 1, its width, and how many rows of samples it has,
// relative to its width. Cells of merged splats have other sizes, and there are none where a strip has one row.
void blurs_lines_tell(Splat splat, int index) {
  bool may_be = clip_is_reflex < 0.5 && float(index) < draw.first_merged;
  float faces = may_be ? asin(clamp(-dot(clip_first.xy, clip_second.xy), 0.0, 1.0)) / RIGHT_ANGLE : 0.0;
  float width = max(clip_first.z + clip_second.z, LEAST_WIDTH);
  float rows = 1.0 + rows_before(clip_first.z) + rows_before(clip_second.z);
  clip_strip = vec3(faces, width, rows / (SAMPLE_SIZE * width));
}

#part screen_space.vert, cuts_at_lines
#include "lib/line_in_picture.glsl"
// The method may have replaced axes: lines refer to the true plane.
void clip_lines_replaced(Plane true_plane, Plane plane, bool in_space) {
  bool is_true = true_plane.a == plane.a && true_plane.b == plane.b;
  clip_in_space = in_space && is_true ? 1.0 : 0.0;
  if (in_space && is_true) return;
  clip_first = line_in_picture(clip_first, true_plane);
  clip_second = line_in_picture(clip_second, true_plane);
}

#part object_space.vert
// Along axes that the method has widened.
void clip_lines_axes(Splat splat, mat2 widened) {
  clip_first.xy = clip_first.xy * widened;
  clip_second.xy = clip_second.xy * widened;
}

#part fragment
// How far inside the lines a place is.
float inside_lines(vec2 place) {
  float first = dot(clip_first.xy, place) + clip_first.z, second = dot(clip_second.xy, place) + clip_second.z;
  return clip_is_reflex > 0.5 ? max(first, second) : min(first, second);
}

bool is_inside_lines(vec2 place) {
  return inside_lines(place) >= 0.0;
}

#part visibility.frag, of_ellipses
// Lines of neighbours meet as the axis of their image sees them. Where the surface bends, their planes differ, and other
// views would see pinholes between them. The reference ends splats at their lines, and has the pinholes.
const float SEAM = 0.006;  // half-axes past its lines in which a splat still occupies depth

void clip_lines_keep() {
  if (inside_lines(place_depth.xy) < -SEAM) discard;
}

#part visibility.frag, of_sprites
void clip_lines_keep() {
  if (!is_inside_lines(gl_FragCoord.xy)) discard;
}

#part object_space.frag
void clip_lines_keep() {
  if (!is_inside_lines(place_depth.xy)) discard;
}

#part point_sprite.frag
void clip_lines_keep() {
  if (!is_inside_lines(gl_FragCoord.xy)) discard;
}

#part screen_space.frag, cuts_at_lines
void clip_lines_bound(inout Candidate c) {
  if (!is_inside_lines(clip_in_space > 0.5 ? c.place.xy : gl_FragCoord.xy)) discard;
}

#part screen_space.vert, blurs_lines
#include "lib/line_in_picture.glsl"

// Signed distances in pixels from the lines, wherever the plane is before its horizon.
void clip_lines_replaced(Plane true_plane, Plane plane, bool in_space) {
  vec3 first = line_in_picture(clip_first, plane), second = line_in_picture(clip_second, plane);
  from_first = first / max(length(first.xy), 1e-20);
  from_second = second / max(length(second.xy), 1e-20);
}

// Where the filter reaches over a line, the face beyond it may be nearer by as much as blurs_lines_bound allows. The
// hardware's depth test must not hide the splat there.
void clip_lines_reach(Plane plane, inout float nearest) {
  nearest = max(min(nearest, plane.depth - length(plane.slope) - most_nearer(plane)), view.near);
}

#part screen_space.frag, blurs_lines
#include "lib/clipped_share.glsl"

void clip_lines_bound(inout Candidate c) {
  if (c.in_space) {
    if (!is_inside_lines(c.place.xy)) discard;
    return;
  }
  c.weight *= clipped_share(c.plane, place_at(c.plane, gl_FragCoord.xy));
  if (!(c.weight > 0.0)) discard;
}

#part screen_space.frag, blurs_lines, depth_bounds
const float TO_WITHIN = 0.75;  // pixels past the line, up to which a sample's area is at most partly beyond it
const float TO_LINE = 0.25;    // pixels by which the distance to the line may be wrong
const float TO_NARROW = 0.1;   // the same for what is narrower than a pixel, where both lines are near
const float STEEPER = 3.0;     // times as steep may a surface be on one side of a line as on the other

// Distance in pixels past the nearest line to a kept point, at most 0 for kept points. way: the unit vector back.
float past_line(vec2 from, out vec2 way) {
  float one = dot(from_first, vec3(from, 1.0)), other = dot(from_second, vec3(from, 1.0));
  bool is_first = clip_is_reflex > 0.5 ? one > other : one < other;
  way = is_first ? from_first.xy : from_second.xy;
  return is_first ? -one : -other;
}

// By how much per pixel the depth from the splat's plane to the visible surface grows, from `gap` here to the next sample
// away from the line. It is endless if that sample is empty.
float growth_of(vec2 from, float gap, Plane plane, vec2 way) {
  ivec2 next = ivec2(floor(from - way)), last = textureSize(depth_bounds, 0) - 1;
  float seen = texelFetch(depth_bounds, clamp(next, ivec2(0), last), 0).z;
  float depth = plane.depth + dot(plane.slope, place_at(plane, vec2(next) + 0.5).uv);
  return (seen - depth - gap) / dot(from - vec2(next) - 0.5, way);
}

// Beyond the line the adjacent face is visible, and may hide the splat's plane, while the pixel's filter reaches over
// the crease. There the splat counts as much as it is visible before the line. The adjacent face meets the splat's
// plane at the line, so the gap between both grows from there to the next pixel. A visible surface that is nearer by a
// larger gap is another one, and hides the splat. If the splat is so narrow that the sample before the line is past
// another line, the same must hold there. Shortly before the line, the gap is too small to tell. If another surface is
// nearer farther before the line, and farther beyond it, a wall goes through: the splat's face ends at its back and is
// not seen. The twin: seen_near_lines in reference/clipped_kernels.py.
void blurs_lines_bound(inout Candidate c) {
  vec2 way, other_way;
  float past = past_line(gl_FragCoord.xy, way), nearer = c.depth - c.seen.z;
  float growth = growth_of(gl_FragCoord.xy, -nearer, c.plane, way);
  if (c.in_space || past <= -TO_LINE) return;
  vec2 before_line = gl_FragCoord.xy + (TO_WITHIN + past) * way;
  ivec2 at = clamp(ivec2(floor(before_line)), ivec2(0), textureSize(depth_bounds, 0) - 1);
  vec2 before = vec2(at) + 0.5;
  float nearer_before = plane_depth(c.plane, place_at(c.plane, before)) - texelFetch(depth_bounds, at, 0).z;
  float past_other = past_line(before, other_way), most_before = 0.0;
  if (past <= 0.0) {
    float farther_beyond = -growth * past_other;
    bool goes_through = nearer_before < STEEPER * farther_beyond && farther_beyond < STEEPER * nearer_before;
    if (nearer_before > 0.0 && goes_through) discard;
    return;
  }
  bool is_narrow = past_other > 0.0;
  if (is_narrow) most_before = -growth_of(before, -nearer_before, c.plane, other_way) * (past_other + TO_NARROW);
  if (nearer_before > max(most_before, 0.0)) discard;
  float room = is_narrow ? 0.0 : (1.0 + 4.0 * draw.epsilon) * c.plane.radius;
  float most = min(most_nearer(c.plane), -growth * (past + (is_narrow ? TO_NARROW : TO_LINE)));
  if (nearer > max(room, most)) discard;
  c.compared = min(c.compared, c.seen.z);
}

#part screen_space.frag, blurs_lines, depth_bounds, silhouettes
const float OTHER_SURFACE = 1.0;  // radii behind the line, at least
const float STEEPEST = 8.0;       // pixels of depth per pixel; steeper, the silhouette filter blurs the crease

// A visible surface that is behind by a larger gap is another one too: the splat's surface ends before it, and the
// silhouette filter blurs that end.
void blurs_lines_ends_bound(inout Candidate c) {
  vec2 way;
  float past = past_line(gl_FragCoord.xy, way), gap = c.seen.w - c.depth;
  float growth = max(growth_of(gl_FragCoord.xy, gap, c.plane, way), 0.0);
  if (c.in_space || past <= 0.0 || gap <= OTHER_SURFACE * c.plane.radius) return;
  if (gap > OTHER_SURFACE * c.plane.radius + growth * (past + TO_LINE)) discard;
  if (growth < STEEPEST * pixel_length(c.plane)) c.compared = c.seen.z;
}
