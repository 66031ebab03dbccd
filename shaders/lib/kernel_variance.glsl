// References: Zwicker et al. 2001 (the kernel is a Gaussian).
// Summary: the variance of a splat's kernel, half-axes squared.

const float KERNEL_VARIANCE = 0.25;
