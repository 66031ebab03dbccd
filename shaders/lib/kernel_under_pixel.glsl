// References: Zwicker et al. 2001 (kernel and pixel filter are Gaussians, and so is their product).
// Summary: the part of a splat that a pixel shows is kernel times pixel filter: a Gaussian narrower than both, in
//          half-axes.

#include "lib/kernel_variance.glsl"

const float LARGEST_PIXEL = 1e8;  // variance, half-axes squared

// q: the pixel's position in the ellipse; change: columns are its change per pixel along x and y; variance: of the
// pixel's filter. Returns the middle and variance; those of the kernel if the pixel is too large for float32, or q is
// infinite.
void kernel_under_pixel(vec2 q, mat2 change, float variance, out vec2 middle, out mat2 seen) {
  mat2 pixel = variance * change * transpose(change);
  float size = pixel[0].x + pixel[1].y, area = variance * determinant(change);
  middle = vec2(0.0);
  seen = mat2(KERNEL_VARIANCE);
  if (size < LARGEST_PIXEL && dot(q, q) < LARGEST_PIXEL) {
    float det = KERNEL_VARIANCE * (KERNEL_VARIANCE + size) + area * area;
    mat2 turned = mat2(pixel[1].y, -pixel[0].y, -pixel[1].x, pixel[0].x);
    middle = KERNEL_VARIANCE / det * (KERNEL_VARIANCE * q + turned * q);
    seen = KERNEL_VARIANCE / det * (KERNEL_VARIANCE * pixel + mat2(area * area));
  }
}
