// SPDX-License-Identifier: MIT
//
// Palettes of evenly rising lightness, those of examples/support/colormap.cpp: lightness, and five tints along the map, in Oklab
// (B. Ottosson, 2020).

const maps = {
  lagoon: { low: 0.14, high: 0.96, tints: [[0.05, 300], [0.12, 282], [0.085, 220], [0.135, 158], [0.12, 108]] },
  ember: { low: 0.1, high: 0.97, tints: [[0.03, 285], [0.13, 305], [0.185, 358], [0.145, 45], [0.06, 100]] },
  dusk: { low: 0.13, high: 0.96, tints: [[0.05, 268], [0.09, 258], [0.02, 240], [0.085, 85], [0.06, 92]] },
};

function linearFrom(lightness, a, b) {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

const encoded = (x) => (x < 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/** The colour, or the nearest one of the same lightness and hue that sRGB has. */
function displayable(lightness, a, b) {
  let [inside, outside] = [0, 1];
  const shown = (part) => linearFrom(lightness, part * a, part * b).every((x) => x > -1e-6 && x < 1 + 1e-6);
  if (shown(1)) inside = 1;
  for (let halving = 0; inside < 1 && halving < 20; ++halving) {
    const middle = (inside + outside) / 2;
    if (shown(middle)) inside = middle;
    else outside = middle;
  }
  return linearFrom(lightness, inside * a, inside * b).map((x) => encoded(Math.min(Math.max(x, 0), 1)));
}

/** Catmull-Rom through four neighbouring control values. */
const through = (a, b, c, d, t) => b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));

/** Red, green and blue of each of 256 entries. */
export function palette(name) {
  const { low, high, tints } = maps[name];
  const points = tints.map(([chroma, hue]) => [chroma * Math.cos((hue * Math.PI) / 180), chroma * Math.sin((hue * Math.PI) / 180)]);
  const point = (i, axis) => points[Math.min(Math.max(i, 0), points.length - 1)][axis];
  const entries = [];
  for (let n = 0; n < 256; ++n) {
    const place = (n / 255) * (points.length - 1);
    const i = Math.min(Math.floor(place), points.length - 2);
    const [a, b] = [0, 1].map((axis) => through(point(i - 1, axis), point(i, axis), point(i + 1, axis), point(i + 2, axis), place - i));
    entries.push(...displayable(low + (n / 255) * (high - low), a, b));
  }
  return new Float32Array(entries);
}

/** Colours of equal lightness around the circle of hues. */
export function hueWheel(count, lightness = 0.8, chroma = 0.12) {
  const entries = Array.from({ length: count }, (_, i) => {
    const angle = (2 * Math.PI * i) / count;
    return displayable(lightness, chroma * Math.cos(angle), chroma * Math.sin(angle));
  });
  return new Float32Array(entries.flat());
}
