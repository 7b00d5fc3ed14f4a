import { Device } from 'streamkernel';
import * as heat from './heat.sk'; // skc compiles it

const canvas = document.querySelector('canvas');
const message = document.querySelector('output');
let { start, diffuse } = heat;

async function run() {
  const device = await Device.create();
  device.onlost = (error) => (message.value = error.message);
  const u = device.stream('float', [256, 256]); // rows first
  start(u);

  let power = 0;
  let at = [0, 0];
  const point = (event) => {
    const box = canvas.getBoundingClientRect();
    at = [((event.clientX - box.left) / box.width) * 256, ((event.clientY - box.top) / box.height) * 256];
    power = event.buttons > 0 ? 0.05 : 0;
  };
  for (const name of ['pointerdown', 'pointermove', 'pointerup']) canvas.addEventListener(name, point);

  const frame = () => {
    if (device.lost) return;
    try {
      for (let i = 0; i < 8; ++i) diffuse(0.2, at, power, u, u); // reads and writes u: legal, and means what it says
      device.draw(u, canvas, { map: 'magma' });
      message.value = '';
    } catch (error) {
      message.value = error.message; // until heat.sk is edited again
    }
    requestAnimationFrame(frame);
  };
  frame();
}

run().catch((error) => (message.value = error.message));

// Vite hands over the edited kernels; the plate stays as warm as it is.
import.meta.hot?.accept('./heat.sk', (edited) => {
  if (edited) ({ start, diffuse } = edited);
});
