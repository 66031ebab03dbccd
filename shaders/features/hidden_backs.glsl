// References: this project (the two sides of cards: sampling/refine/two_sided.py).
// Summary: opaque splats whose backs are hidden by the other side of their card are not drawn from behind.

#part splat
bool has_hidden_back;  // of the splat that was fetched last

void hidden_backs_unpack(inout StoredSplat stored, int index) {
  has_hidden_back = take_hidden_back(stored, index);
}

void hidden_backs_hide(inout Splat splat) {
  splat.is_hidden = splat.is_hidden || (splat.is_back && has_hidden_back);
}
