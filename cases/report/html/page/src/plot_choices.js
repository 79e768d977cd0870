// The first choices of the plots over time, and the finger that moves their time.

// The pairs of bodies of which any run tells a contact force.
export function pairsOf(data) {
  const pairs = new Map();
  for (const { forces } of data.runs.values())
    for (const { a, b } of forces ?? []) pairs.set(`${a} ${b}`, { key: `${a} ${b}`, a, b });
  return [...pairs.values()];
}

// The body and the coordinate that move most; the angle if bodies only rotate.
export function liveliest(bodies, data) {
  const motion = data.truth?.motion ?? [...data.runs.values()].find((run) => run.motion)?.motion;
  const moving = Math.max(
    0,
    bodies.findIndex((b) => !b.fixed),
  );
  if (!motion) return [moving, 1];
  const range = [0, 1, 2].map((k) => {
    let low = Infinity,
      high = -Infinity;
    for (let slot = 7 * moving + k; slot < motion.values.length; slot += 7 * motion.bodies)
      (low = Math.min(low, motion.values[slot])), (high = Math.max(high, motion.values[slot]));
    return high - low;
  });
  const best = range.indexOf(Math.max(...range));
  return [moving, range[best] > 1e-9 ? best : 3];
}

// A finger on a plot sets the time; up and down still scrolls the page.
export function followTouch(chart, seek) {
  const { over } = chart;
  over.style.touchAction = "pan-y";
  const move = (event) => {
    if (event.pointerType !== "touch") return;
    seek(chart.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
  };
  over.addEventListener("pointerdown", move);
  over.addEventListener("pointermove", move);
}
