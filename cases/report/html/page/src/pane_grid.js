// The places of several pictures side by side, in pixels: x, y, width and height of each.
export function paneGrid(panes, width, height) {
  const columns = Math.ceil(Math.sqrt((panes.length * width) / Math.max(height, 1) / 1.3)) || 1,
    rows = Math.ceil(panes.length / Math.min(columns, panes.length));
  const across = Math.ceil(panes.length / rows),
    w = width / across,
    h = height / rows;
  return panes.map((pane, i) => ({ ...pane, x: (i % across) * w, y: Math.floor(i / across) * h, width: w, height: h }));
}
