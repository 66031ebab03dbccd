// References: rendering/view.py, `DrawItem.is_whole`.
// Summary: the position of all corners of skipped splats, so that they have no area. If the whole instance is in the
//          picture, so is this position: outside the view volume it would make the hardware clip neighbouring
//          triangles. If some of the instance is clipped anyway, it is in front of the near plane, where it is rejected
//          fastest.

#define NOWHERE vec4(0.0, 0.0, draw.nowhere, 1.0)
