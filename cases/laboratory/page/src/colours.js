// The colours of up to four runs, for light and dark pages: four colours of Okabe and Ito's palette, which colour-blind people tell
// apart (Okabe, Ito, "Color Universal Design", 2008). Each run's line is dashed in its own way, too.
export const colours = [
  ["#0072b2", "#56b4e9"],
  ["#c04d00", "#f0a050"],
  ["#00795a", "#3fd0a0"],
  ["#a84f80", "#e6a5cc"],
];
export const dashes = [null, [9, 4], [3, 3], [9, 3, 2, 3]];
