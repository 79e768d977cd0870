// Vectors as lists of three numbers.
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (v) => v.map((x) => x / (Math.hypot(...v) || 1));
export const moved = (p, v, by) => p.map((x, k) => x + by * v[k]); // p + by v
