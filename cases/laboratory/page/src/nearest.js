// The nearest number of a list by ratio, and the nearest word by edit distance.
export const nearest = (value, list) =>
  list.reduce((best, one) => (Math.abs(Math.log(one / value)) < Math.abs(Math.log(best / value)) ? one : best));

function distance(a, b) {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j);
  for (let i = 1; i <= a.length; ++i) {
    const next = [i];
    for (let j = 1; j <= b.length; ++j)
      next[j] = Math.min(row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] === b[j - 1] ? 0 : 1));
    row = next;
  }
  return row[b.length];
}

// Null for an empty list.
export function nearestWord(word, list) {
  const short = word.slice(0, 80).toLowerCase();
  let best = null,
    least = Infinity;
  for (const one of list) {
    const far = distance(short, one.toLowerCase());
    if (far < least) (least = far), (best = one);
  }
  return best;
}
