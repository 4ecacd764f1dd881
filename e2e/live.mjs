// Tests of the page with `tumble view` as its server, in a real browser.
//
//   node live.mjs TUMBLE [PICTURES]
//
// TUMBLE is the program. Screenshots are written to PICTURES if given.

import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import readline from 'node:readline';
import { execFileSync, spawn } from 'node:child_process';
import { check, closeSilent, finish, launch, open, until } from './browser.mjs';

const [, , tumble, pictures] = process.argv;
const TIMEOUT = 60000; // ms
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'tumble-live-'));
// a small window, since rendering is in software
const viewport = { width: 1000, height: 660 };
const running = new Set();

// a `tumble view` process
class Viewer {
  async start(what, port = 0) {
    this.child = spawn(tumble, ['view', what, '--no-open', '--port', String(port)], { stdio: ['ignore', 'pipe', 'ignore'], cwd: folder });
    running.add(this.child);
    this.exited = new Promise((done) => this.child.once('exit', done));
    this.exited.then(() => running.delete(this.child));
    const lines = readline.createInterface({ input: this.child.stdout });
    this.address = await within('the address', new Promise((done, fail) => {
      lines.once('line', done);
      lines.once('close', () => fail(new Error(`tumble view ${what} ended without an address`)));
    }));
    this.port = Number(new URL(this.address).port);
  }

  async stop(signal = 'SIGINT') {
    this.child.kill(signal);
    return within('the exit of the viewer', this.exited);
  }
}

function within(what, promise) {
  let timer;
  const timeout = new Promise((_, fail) => (timer = setTimeout(() => fail(new Error(`${what}: not within ${TIMEOUT} ms`)), TIMEOUT)));
  return Promise.race([promise, timeout]).finally(() => clearTimeout(timer));
}

const screenshot = (page, name) => pictures && page.screenshot({ path: path.join(pictures, `${name}.png`) });
const lastFrame = (page) => page.evaluate(() => {
  const { time, step, ledger } = tumble.app.recording.frames.at(-1);
  return { time, step, total: ledger[9], residual: ledger[10] };
});
const parameter = (page, key) => page.evaluate((wanted) => tumble.app.header.parameters.find(({ key: k }) => k === wanted).value, key);
const slider = (page, key) => page.locator(`.parameter[title="${key}"] input`);
const connected = (what, page) => until(what, page, () => document.querySelector('#connection')?.textContent === 'Connected' && window.tumble?.app.recording.length > 0);
const paused = (what, page) => until(what, page, () => document.querySelector('#play').getAttribute('aria-label') === 'Play');

// moves a slider to a position from 0 to 1000 and leaves the focus in it; opens its section first
async function slide(page, key, position) {
  await slider(page, key).evaluate((input) => {
    for (let group = input.closest('details'); group; group = group.parentElement.closest('details')) group.open = true;
  });
  await slider(page, key).fill(String(position));
}

async function time(page) {
  await connected('the page connects', page);
  await until('time advances', page, () => tumble.app.player.time > 0.2);
  await until('the clock shows it', page, () => Number(document.querySelector('#readout').textContent.split(' ')[0]) > 0.2);
  await page.click('#play');
  await paused('pause is confirmed', page);
  const before = await lastFrame(page);
  await page.waitForTimeout(300);
  const after = await lastFrame(page);
  check('pause stops the simulation', after.step === before.step, `${before.step} and ${after.step}`);
  await page.click('#forward');
  await until('one step is one step', page, (step) => tumble.app.recording.frames.at(-1).step === step + 1, before.step);
  const { time: later } = await lastFrame(page);
  const dt = await page.evaluate(() => tumble.app.header.dt);
  check('and takes exactly one dt', later === (before.step + 1) * dt, `${later - before.time} and ${dt}`);
  const shown = await page.evaluate(() => {
    const [x, y] = tumble.project(0);
    return { on: tumble.pixel(x, y), off: tumble.pixel(5, 500) };
  });
  const [r, , b] = shown.on;
  check('the body is drawn', b > r + 40 && shown.off.some((x) => x > 0), JSON.stringify(shown));
}

async function parameters(page) {
  await slide(page, 'collision.collision_stiffness', 600);
  await until('a stiffness is confirmed by the server', page, () => tumble.app.header.parameters.find(({ key }) => key === 'collision.collision_stiffness').value === 1e5);
  await slide(page, 'gravity.1', 400);
  await until('gravity is confirmed', page, () => Math.abs(tumble.app.header.gravity[1] + 4) < 1e-9);
  check('other parameters keep their values', (await parameter(page, 'collision.collision_stiffness')) === 1e5);
  await slide(page, 'collision.collision_stiffness', 1000);
  await until('a stiffness above the stability limit is refused with a message', page, () => document.querySelector('#notice').textContent.includes('dt'));
  const text = await page.locator('.parameter[title="collision.collision_stiffness"] output').innerText();
  check('its slider goes back', !text.includes('10⁷') && Math.abs(Number(await slider(page, 'collision.collision_stiffness').inputValue()) - 600) < 2, text);
  await slide(page, 'body.0.scale', 330);
  await until('a pending parameter is marked', page, () => document.querySelector('.parameter[data-pending="true"]')?.textContent.includes('waiting'));
  await screenshot(page, 'live');
}

async function reset(page) {
  const before = await lastFrame(page);
  await page.click('#first');
  await until('a reset goes back to 0', page, () => tumble.app.recording.frames.at(-1).step === 0 && tumble.app.player.time === 0);
  check('the time was not 0 before', before.step > 0);
  await until('nothing is pending', page, () => document.querySelector('.parameter[data-pending="true"]') === null);
  check('the parameters keep their values', (await parameter(page, 'collision.collision_stiffness')) === 1e5);
}

// measures simulated seconds per second
async function measureSpeed(page, milliseconds) {
  const read = () => page.evaluate(() => ({ clock: performance.now(), time: tumble.app.recording.end }));
  const from = await read();
  await page.waitForTimeout(milliseconds);
  const to = await read();
  return (1000 * (to.time - from.time)) / (to.clock - from.clock);
}

async function speeds(page) {
  await page.selectOption('#speed', '0.05');
  await page.click('#play');
  await until('slow motion advances', page, () => tumble.app.recording.end > 0);
  const slow = await measureSpeed(page, 800);
  check('the speed is low', slow > 0.01 && slow < 0.1, `${slow} s/s`);
}

// Runs at maximum speed until the body is shown at rest, so that the mouse can hit it. At that speed the page shows an
// earlier frame than the latest one until it draws again, so the latest frame alone does not tell what the mouse hits.
async function waitForRest(what, page) {
  await page.selectOption('#speed', 'null');
  const { time: from } = await lastFrame(page);
  await until(what, page, (then) => {
    const { player, recording } = tumble.app;
    const isSlow = ({ bodies }) => Math.hypot(...bodies.subarray(7, 13)) < 0.05;
    // the frame before the shown one too: one alone may be an apex
    return player.time > then + 3 && recording.frames.slice(recording.indexAt(player.time) - 1).every(isSlow);
  }, from);
  await page.selectOption('#speed', '1');
}

// the body follows the pointer, and the residual stays small; `method` is shift or button
async function drag(page, by, method) {
  await waitForRest(`${method}: the body is at rest`, page);
  if (method === 'shift') await page.keyboard.down('Shift');
  else await page.click('#drag');
  const { residual: before } = await lastFrame(page);
  const [x, y] = await page.evaluate(() => tumble.project(0));
  await page.mouse.move(x, y);
  await page.mouse.down();
  const hit = await page.evaluate(([px, py]) => {
    const { mouseSpring, player, recording } = tumble.app;
    const under = document.elementFromPoint(px, py);
    return { attached: mouseSpring.attached !== null, pressed: [px, py], centre: tumble.project(0), under: under?.id || under?.tagName, shown: player.time, end: recording.end };
  }, [x, y]);
  check(`${method}: the pointer hits the body`, hit.attached, JSON.stringify(hit));
  await page.mouse.move(x + by[0], y + by[1], { steps: 8 });
  await until(`${method}: the body follows the pointer`, page, ([px, py, far]) => {
    const [bx, by] = tumble.project(0);
    return Math.hypot(bx - px, by - py) < 0.5 * far;
  }, [x + by[0], y + by[1], Math.hypot(...by)]);
  await screenshot(page, `live-drag-${method}`);
  const wasAttached = await page.evaluate(() => tumble.app.mouseSpring.attached !== null);
  await page.mouse.up();
  if (method === 'shift') await page.keyboard.up('Shift');
  else await page.click('#drag');
  const { residual, total } = await lastFrame(page);
  check('the residual stays small', Math.abs(residual - before) < 0.02 * Math.abs(total) + 0.5, `${before} and ${residual} of ${total} J`);
  check('the mouse spring is released', wasAttached && (await page.evaluate(() => tumble.app.mouseSpring.attached === null)));
}

async function save(page) {
  // a state in which the mouse has just pressed the body into a wall is refused
  await waitForRest('the body is at rest again', page);
  const saving = page.waitForEvent('download', { timeout: TIMEOUT });
  await page.click('#save');
  const saved = await saving;
  const file = path.join(folder, 'saved.toml');
  await saved.saveAs(file);
  check('saving downloads a scene file', saved.suggestedFilename() === 'task2.toml' && fs.readFileSync(file, 'utf8').includes('[[body]]'));
  execFileSync(tumble, ['run', file, '--duration', '0.02', '--out', path.join(folder, 'run')], { stdio: 'ignore' });
  check('the saved scene runs', fs.existsSync(path.join(folder, 'run', 'motion.html')));
}

// two pages show one simulation
async function secondPage(browser, page, address) {
  // pause one page: two at a time are too slow in software
  await page.click('#play');
  await paused('pause again', page);
  const other = await open(browser, address, { viewport: { width: 800, height: 500 } });
  await connected('a second page connects', other);
  await page.click('#play');
  await until('the second page shows that the first plays', other, () => document.querySelector('#play').getAttribute('aria-label') === 'Pause');
  await page.click('#play');
  await paused('the second page shows that the first pauses', other);
  await paused('and so does the first', page);
  const { step } = await lastFrame(page);
  await until('both show the same time', other, (s) => tumble.app.recording.frames.at(-1).step === s && tumble.app.player.time === tumble.app.recording.end, step);
  await slide(other, 'gravity.1', 255);
  await until('a slider of the second page moves that of the first', page, () => document.querySelector('.parameter[title="gravity.1"] output').textContent.includes('9.8'));
  // one page shows an earlier time while the other resets
  await page.keyboard.press('ArrowLeft');
  await other.click('#first');
  await until('the first page shows the reset', page, () => tumble.app.recording.end === 0 && tumble.app.player.time === 0);
  await closeSilent('the second page', other);
}

async function reconnection(page, viewer) {
  await page.click('#play');
  await until('it plays', page, () => tumble.app.recording.end > 0.3);
  const { port } = viewer;
  await viewer.stop('SIGKILL');
  await until('a lost connection is shown', page, () => /^(No connection|Connecting)/.test(document.querySelector('#connection').textContent));
  await viewer.start('task2', port);
  await connected('the page reconnects', page);
  await until('the page shows the new run', page, () => tumble.app.recording.start < 0.3 && tumble.app.recording.end > 0.1 && tumble.app.recording.frames.length > 3);
  check('with the parameters of the new server', (await parameter(page, 'collision.collision_stiffness')) === 1e4);
  const status = await viewer.stop();
  check('Ctrl-C stops the viewer with status 0', status === 0, String(status));
  await viewer.start('slope', port);
  await until('another scene on the same port is shown', page, () => document.querySelector('#name').textContent === 'slope' && document.querySelector('#connection').textContent === 'Connected');
}

async function slope(browser, viewer) {
  const page = await open(browser, viewer.address, { viewport, reducedMotion: 'no-preference' });
  await connected('the slope connects', page);
  await page.click('#first');
  await slide(page, 'collision.friction_stiffness', 800);
  await until('friction is confirmed by the server', page, () => tumble.app.header.parameters.find(({ key }) => key === 'collision.friction_stiffness').value === 1.6);
  await until('the box dissipates energy', page, () => tumble.app.recording.frames.at(-1).ledger[4] > 0.01);
  await page.keyboard.press('6');
  await screenshot(page, 'live-slope');
  await closeSilent('slope', page);
}

// the integrator changes at the present state, with the step that the page announced
async function integrators(browser) {
  const viewer = new Viewer();
  await viewer.start('heap');
  const page = await open(browser, viewer.address, { viewport });
  await connected('the heap connects', page);
  await until('the plot shows what the implicit solution loses', page, () => document.querySelector('.legend').innerText.includes('Numerical'));
  for (const name of ['splitting', 'implicit']) {
    const { dt } = await page.evaluate((wanted) => tumble.app.header.integrators.find((choice) => choice.name === wanted), name);
    const { time: from } = await lastFrame(page);
    await page.selectOption('#integrator', name);
    await until(`${name} is confirmed with its step`, page, ([n, h]) => tumble.app.header.integrator === n && tumble.app.header.dt === h, [name, dt]);
    await until('time goes on', page, (t) => tumble.app.recording.end > t + 0.1 && tumble.app.recording.start === 0, from);
  }
  await page.selectOption('#integrator', 'splitting');
  await until('splitting once more', page, () => tumble.app.header.integrator === 'splitting');
  await slide(page, 'dt', 1000);
  await until('a step that is too long for it is refused with a way out', page, () => document.querySelector('#notice').textContent.includes('implicit'));
  check('the integrator stays', (await page.inputValue('#integrator')) === 'splitting');
  await screenshot(page, 'live-integrators');
  await closeSilent('integrators', page);
  await viewer.stop();
}

async function finished(browser) {
  const run = path.join(folder, 'finished');
  execFileSync(tumble, ['run', 'task2', '--duration', '0.5', '--out', run], { stdio: 'ignore' });
  const viewer = new Viewer();
  await viewer.start(run);
  const page = await open(browser, viewer.address, { viewport });
  await until('a finished run is served', page, () => window.tumble?.app.recording.length === 51);
  await page.keyboard.press('End');
  check('End shows its last frame', (await page.evaluate(() => tumble.app.player.time)) === 0.5);
  await closeSilent('a finished run', page);
  await viewer.stop();
}

const browser = await launch();
try {
  const viewer = new Viewer();
  await viewer.start('task2');
  const page = await open(browser, viewer.address, { viewport });
  await time(page);
  await parameters(page);
  await reset(page);
  await speeds(page);
  await drag(page, [-120, -110], 'shift');
  await drag(page, [100, -60], 'button');
  await save(page);
  await secondPage(browser, page, viewer.address);
  check('the live page has no console messages', page.messages.length === 0, page.messages.slice(0, 5).join(' | '));
  await reconnection(page, viewer);
  // the browser reports every failed connection; nothing else may be reported
  const others = page.messages.filter((text) => !text.includes('WebSocket connection to'));
  check('no messages except for failed connections', others.length === 0, others.slice(0, 5).join(' | '));
  await page.context().close();
  await slope(browser, viewer);
  await viewer.stop();
  await integrators(browser);
  await finished(browser);
} catch (error) {
  check('the test runs to its end', false, error.message);
} finally {
  await browser.close();
  for (const child of running) child.kill('SIGKILL');
  fs.rmSync(folder, { recursive: true, force: true });
}
finish();
