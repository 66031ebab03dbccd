// References: rendering/view.py, `DrawItem.is_whole`.
// Summary: where all corners of what is not drawn go, so that they enclose nothing. Where the whole instance is in the
//          picture that place is too: beyond a plane of the view it would make what is drawn beside it go through the
//          clipping that none of it needs. Where some is clipped in any case it lies before the near plane, which ends it
//          soonest.

#define NOWHERE vec4(0.0, 0.0, draw.nowhere, 1.0)
