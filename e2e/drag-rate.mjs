// Measures whether a live simulation keeps up with the clock while the mouse spring pulls a body through it; without a browser.
//
//   node drag-rate.mjs TUMBLE [SCENE] [ARGUMENTS OF tumble view…]
//
// It prints simulated seconds per second of the clock, before, during and after the drag. No page is drawn: a browser on the same
// machine takes processor time too.

import readline from 'node:readline';
import { createRequire } from 'node:module';
import path from 'node:path';
import { spawn } from 'node:child_process';

const { WebSocket } = createRequire(path.join(import.meta.dirname, '.tools', 'here.js'))('ws');
const [, , tumble, scene = 'heap', ...rest] = process.argv;
const LEDGER_BYTES = 88;
const BODY_BYTES = 88;
const SECONDS = 6; // of each measurement
const RADIUS = 0.35; // of the circle on which the target moves (m)
const HEIGHT = 0.45; // of the target (m)
const TURN = 3; // seconds for each turn

const child = spawn(tumble, ['view', scene, '--no-open', '--port', '0', ...rest], { stdio: ['ignore', 'pipe', 'inherit'] });
process.on('exit', () => child.kill('SIGINT'));
const address = await new Promise((done) => readline.createInterface({ input: child.stdout }).once('line', done));
const socket = new WebSocket(`${address.replace('http', 'ws')}live`, { origin: address.slice(0, -1) });
let frame = null;
let status = null;
let frames = 0;
socket.on('message', (data, isBinary) => {
  if (isBinary) {
    frames += 1;
    frame = data;
  } else {
    const message = JSON.parse(data.toString());
    if (message.type === 'status') status = message;
    if (message.type === 'refused') console.log(`refused: ${message.why}`);
  }
});
await new Promise((done) => socket.once('open', done));

const send = (message) => socket.send(JSON.stringify(message));
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
const time = () => (frame ? frame.readDoubleLE(0) : 0);
const position = (body) => [0, 4, 8].map((at) => frame.readFloatLE(LEDGER_BYTES + BODY_BYTES * body + at));
const target = () => {
  const angle = (2 * Math.PI * performance.now()) / (1000 * TURN);
  return [RADIUS * Math.cos(angle), HEIGHT, RADIUS * Math.sin(angle)];
};

// simulated seconds per second, and frames per second; also the lowest rate over half a second
async function measure(what, each) {
  const from = { clock: performance.now(), time: time(), frames };
  const rates = [];
  let last = from;
  while (performance.now() < from.clock + 1000 * SECONDS) {
    each();
    await sleep(16);
    const now = { clock: performance.now(), time: time() };
    if (now.clock > last.clock + 500) {
      rates.push((1000 * (now.time - last.time)) / (now.clock - last.clock));
      last = now;
    }
  }
  const seconds = (performance.now() - from.clock) / 1000;
  const rate = (time() - from.time) / seconds;
  console.log(`${what}: ${rate.toFixed(3)} simulated s per s, lowest in half a second ${Math.min(...rates).toFixed(3)}, ${((frames - from.frames) / seconds).toFixed(0)} frames per s, ${status.steps_per_second} steps per s of stepping`);
}

await measure('falling', () => {});
const count = (frame.length - LEDGER_BYTES) / BODY_BYTES;
const bodies = [...Array(count).keys()].map((body) => ({ body, at: position(body) }));
// a body at the bottom, near the circle
const distance = ({ at: [x, y, z] }) => Math.hypot(Math.hypot(x, z) - RADIUS, y - HEIGHT);
const { body } = bodies.sort((a, b) => distance(a) - distance(b))[0];
send({ type: 'grab', body, particle: 0, target: target() });
let travelled = 0;
let before = position(body);
await measure(`dragging body ${body}`, () => {
  send({ type: 'move', target: target() });
  const now = position(body);
  travelled += Math.hypot(...now.map((x, i) => x - before[i]));
  before = now;
});
console.log(`it moved along ${travelled.toFixed(2)} m${status.error ? `; error: ${status.error}` : ''}`);
send({ type: 'release' });
await measure('after release', () => {});
socket.close();
process.exit();
