// SPDX-License-Identifier: MIT
//
// A picture for those who have none at hand: a table with a jug, fruit, a book and a candle, drawn with gradients.

/** Draws into a 2D context; lengths are parts of the height. */
export function drawStillLife(c, width, height) {
  c.save();
  c.scale(height, height);
  const right = width / height;

  const ramp = (x0, y0, x1, y1, ...stops) => {
    const gradient = c.createLinearGradient(x0, y0, x1, y1);
    stops.forEach((colour, i) => gradient.addColorStop(i / (stops.length - 1), colour));
    return gradient;
  };
  const shape = (fill, path) => {
    c.fillStyle = fill;
    c.beginPath();
    path();
    c.fill();
  };
  const ball = (x, y, radius, light, dark, squash = 1) => {
    shape('rgb(20 16 14 / 35%)', () => c.ellipse(x + 0.35 * radius, y + 0.9 * radius * squash, 1.15 * radius, 0.3 * radius, 0, 0, 7));
    const gradient = c.createRadialGradient(x - 0.35 * radius, y - 0.4 * radius, 0.08 * radius, x, y, 1.05 * radius);
    [[0, '#fffdf4'], [0.18, light], [1, dark]].forEach(([at, colour]) => gradient.addColorStop(at, colour));
    shape(gradient, () => c.ellipse(x, y, radius, radius * squash, 0, 0, 7));
  };

  shape(ramp(0, 0, right, 0.7, '#d9d2c3', '#8f8a82'), () => c.rect(0, 0, right, 1)); // the wall
  shape(ramp(0, 0.05, 0.45, 0.5, '#f3efe4', '#cfd8dd'), () => c.rect(0.08, 0.08, 0.3, 0.36)); // a window
  c.strokeStyle = '#6d6257';
  c.lineWidth = 0.014;
  c.strokeRect(0.08, 0.08, 0.3, 0.36);
  for (const [x0, y0, x1, y1] of [[0.23, 0.08, 0.23, 0.44], [0.08, 0.26, 0.38, 0.26]]) {
    c.beginPath();
    c.moveTo(x0, y0);
    c.lineTo(x1, y1);
    c.stroke();
  }
  shape(ramp(0, 0.64, 0, 1, '#a8744a', '#6b4226'), () => c.rect(0, 0.66, right, 0.4)); // the table
  shape('#5b3820', () => c.rect(0, 0.955, right, 0.05));

  shape('rgb(20 16 14 / 30%)', () => c.ellipse(0.66, 0.765, 0.24, 0.035, 0, 0, 7)); // a jug
  shape(ramp(0.4, 0, 0.74, 0, '#28556b', '#8fc3d3', '#3c7f97', '#173a4b'), () => {
    c.moveTo(0.5, 0.2);
    c.bezierCurveTo(0.52, 0.36, 0.36, 0.42, 0.4, 0.62);
    c.bezierCurveTo(0.42, 0.78, 0.7, 0.78, 0.72, 0.62);
    c.bezierCurveTo(0.76, 0.42, 0.6, 0.36, 0.62, 0.2);
    c.closePath();
  });
  shape('#15313e', () => c.ellipse(0.56, 0.2, 0.062, 0.02, 0, 0, 7));
  c.strokeStyle = '#2d6379';
  c.lineWidth = 0.026;
  c.beginPath();
  c.moveTo(0.62, 0.27);
  c.bezierCurveTo(0.8, 0.24, 0.82, 0.5, 0.725, 0.52);
  c.stroke();

  shape(ramp(0.9, 0.6, 1.2, 0.8, '#8d2f2a', '#5a1a1c'), () => { // a book
    c.moveTo(0.84, 0.7);
    c.lineTo(1.22, 0.66);
    c.lineTo(1.28, 0.74);
    c.lineTo(0.88, 0.79);
  });
  shape('#efe6d0', () => {
    c.moveTo(0.88, 0.79);
    c.lineTo(1.28, 0.74);
    c.lineTo(1.28, 0.785);
    c.lineTo(0.88, 0.84);
  });
  shape(ramp(1.02, 0, 1.1, 0, '#f7f0dc', '#cdbf9d'), () => c.rect(1.03, 0.36, 0.07, 0.34)); // a candle
  shape(ramp(0, 0.26, 0, 0.36, '#fff6c8', '#f2a33a'), () => c.ellipse(1.065, 0.305, 0.018, 0.05, 0, 0, 7));

  ball(0.28, 0.76, 0.1, '#e7b04a', '#8d4d12');
  ball(0.45, 0.82, 0.085, '#d9563f', '#6d1616', 0.94);
  ball(0.16, 0.85, 0.075, '#a3bf55', '#3f5a1d');
  c.restore();
}
