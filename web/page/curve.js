// Predicted times over cell sizes, as the worker and the page read them.

/** Milliseconds at a cell size, by the samples { size, ms } around it or, beyond them, the last two. */
export function predictedAt({ curve }, size) {
  const place = curve.findIndex((sample) => sample.size >= size);
  const after = place < 0 ? curve.length - 1 : Math.max(1, place);
  const [a, b] = [curve[after - 1], curve[after]];
  const part = Math.log(size / a.size) / Math.log(b.size / a.size);
  return Math.exp(Math.log(a.ms) * (1 - part) + Math.log(b.ms) * part);
}
