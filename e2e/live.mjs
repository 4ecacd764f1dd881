// The page against the real `tumble view`, in a real browser.
//
//   node live.mjs TUMBLE [PICTURES]
//
// TUMBLE is the program; PICTURES gets screenshots if named.

import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import readline from 'node:readline';
import { execFileSync, spawn } from 'node:child_process';
import { check, finish, launch, open, quiet, until } from './browser.mjs';

const [, , tumble, pictures] = process.argv;
const LONGEST = 60000;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'tumble-live-'));
// small pictures: the processor draws them
const viewport = { width: 1000, height: 660 };
const running = new Set();

// a viewer that is ended with the test
class Viewer {
  async start(what, port = 0) {
    this.child = spawn(tumble, ['view', what, '--no-open', '--port', String(port)], { stdio: ['ignore', 'pipe', 'ignore'], cwd: folder });
    running.add(this.child);
    this.over = new Promise((done) => this.child.once('exit', done));
    this.over.then(() => running.delete(this.child));
    const lines = readline.createInterface({ input: this.child.stdout });
    this.address = await within('the address', new Promise((done, fail) => {
      lines.once('line', done);
      lines.once('close', () => fail(new Error(`tumble view ${what} ended without an address`)));
    }));
    this.port = Number(new URL(this.address).port);
  }

  async stop(signal = 'SIGINT') {
    this.child.kill(signal);
    return within('the end of the viewer', this.over);
  }
}

function within(what, promise) {
  let timer;
  const late = new Promise((_, fail) => (timer = setTimeout(() => fail(new Error(`${what}: not within ${LONGEST} ms`)), LONGEST)));
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

const picture = (page, name) => pictures && page.screenshot({ path: path.join(pictures, `${name}.png`) });
const film = (page) => page.evaluate(() => {
  const { time, step, ledger } = tumble.app.film.frames.at(-1);
  return { time, step, total: ledger[6], residual: ledger[7] };
});
const parameter = (page, key) => page.evaluate((wanted) => tumble.app.head.parameters.find(({ key: k }) => k === wanted).value, key);
const slider = (page, key) => page.locator(`.parameter[title="${key}"] input`);
const connected = (what, page) => until(what, page, () => document.querySelector('#link')?.textContent === 'Connected' && window.tumble?.app.film.length > 0);
const paused = (what, page) => until(what, page, () => document.querySelector('#play').getAttribute('aria-label') === 'Play');

// the place of a slider, from 0 to 1000, with the focus left in it; its group is unfolded first
async function slide(page, key, part) {
  await slider(page, key).evaluate((input) => {
    for (let group = input.closest('details'); group; group = group.parentElement.closest('details')) group.open = true;
  });
  await slider(page, key).fill(String(part));
}

async function time(page) {
  await connected('the page connects and says so', page);
  await until('time goes on', page, () => tumble.app.player.time > 0.2);
  await until('the clock tells it', page, () => Number(document.querySelector('#readout').textContent.split(' ')[0]) > 0.2);
  await page.click('#play');
  await paused('pause is told', page);
  const before = await film(page);
  await page.waitForTimeout(300);
  const after = await film(page);
  check('pause stops the simulation', after.step === before.step, `${before.step} and ${after.step}`);
  await page.click('#on');
  await until('one step is one step', page, (step) => tumble.app.film.frames.at(-1).step === step + 1, before.step);
  const { time: later } = await film(page);
  const dt = await page.evaluate(() => tumble.app.head.dt);
  check('and takes exactly one dt', later === (before.step + 1) * dt, `${later - before.time} and ${dt}`);
  const shown = await page.evaluate(() => {
    const [x, y] = tumble.project(0);
    return { on: tumble.pixel(x, y), off: tumble.pixel(5, 500) };
  });
  const [r, , b] = shown.on;
  check('the body is on the canvas', b > r + 40 && shown.off.some((x) => x > 0), JSON.stringify(shown));
}

async function settings(page) {
  await slide(page, 'collision.collision_stiffness', 600);
  await until('a stiffness comes back from the server', page, () => tumble.app.head.parameters.find(({ key }) => key === 'collision.collision_stiffness').value === 1e5);
  await slide(page, 'gravity.1', 400);
  await until('so does gravity', page, () => Math.abs(tumble.app.head.gravity[1] + 4) < 1e-9);
  check('the other numbers stay', (await parameter(page, 'collision.collision_stiffness')) === 1e5);
  await slide(page, 'collision.collision_stiffness', 1000);
  await until('what is too stiff for dt is refused, in words', page, () => document.querySelector('#notice').textContent.includes('dt'));
  const told = await page.locator('.parameter[title="collision.collision_stiffness"] output').innerText();
  check('and its slider goes back', !told.includes('10⁷') && Math.abs(Number(await slider(page, 'collision.collision_stiffness').inputValue()) - 600) < 2, told);
  await slide(page, 'body.0.scale', 330);
  await until('what waits for a reset says so', page, () => document.querySelector('.parameter[data-pending="true"]')?.textContent.includes('waits'));
  await picture(page, 'live');
}

async function reset(page) {
  const before = await film(page);
  await page.click('#first');
  await until('a reset goes back to 0', page, () => tumble.app.film.frames.at(-1).step === 0 && tumble.app.player.time === 0);
  check('and was somewhere else', before.step > 0);
  await until('nothing waits any more', page, () => document.querySelector('.parameter[data-pending="true"]') === null);
  check('the settings outlive it', (await parameter(page, 'collision.collision_stiffness')) === 1e5);
}

// simulated seconds in a second of the clock, while both go on
async function pace(page, milliseconds) {
  const read = () => page.evaluate(() => ({ clock: performance.now(), time: tumble.app.film.end }));
  const from = await read();
  await page.waitForTimeout(milliseconds);
  const to = await read();
  return (1000 * (to.time - from.time)) / (to.clock - from.clock);
}

async function speeds(page) {
  await page.selectOption('#speed', '0.05');
  await page.click('#play');
  await until('slow motion goes on', page, () => tumble.app.film.end > 0);
  const slow = await pace(page, 800);
  check('and is slow', slow > 0.01 && slow < 0.1, `${slow} s/s`);
}

// as fast as it goes, until the body lies still: then it is still there when the mouse comes
async function rest(what, page) {
  await page.selectOption('#speed', 'null');
  const { time: from } = await film(page);
  await until(what, page, (then) => {
    const { time: now, bodies } = tumble.app.film.frames.at(-1);
    return now > then + 3 && Math.hypot(...bodies.subarray(7, 13)) < 0.05;
  }, from);
  await page.selectOption('#speed', '1');
}

// the body follows the pointer, and the ledger still adds up
async function drag(page, by, grab) {
  await rest(`${grab}: the body lies still`, page);
  if (grab === 'shift') await page.keyboard.down('Shift');
  else await page.click('#grab');
  const { residual: before } = await film(page);
  const [x, y] = await page.evaluate(() => tumble.project(0));
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + by[0], y + by[1], { steps: 8 });
  await until(`${grab}: the body comes to the pointer`, page, ([px, py, far]) => {
    const [bx, by] = tumble.project(0);
    return Math.hypot(bx - px, by - py) < 0.5 * far;
  }, [x + by[0], y + by[1], Math.hypot(...by)]);
  await picture(page, `live-drag-${grab}`);
  const thread = await page.evaluate(() => tumble.app.grab.held !== null);
  await page.mouse.up();
  if (grab === 'shift') await page.keyboard.up('Shift');
  else await page.click('#grab');
  const { residual, total } = await film(page);
  check('the residual stays small', Math.abs(residual - before) < 0.02 * Math.abs(total) + 0.5, `${before} and ${residual} of ${total} J`);
  check('and the hand lets go', thread && (await page.evaluate(() => tumble.app.grab.held === null)));
}

async function save(page) {
  const saving = page.waitForEvent('download', { timeout: LONGEST });
  await page.click('#save');
  const saved = await saving;
  const file = path.join(folder, 'saved.toml');
  await saved.saveAs(file);
  check('saving hands over a scene', saved.suggestedFilename() === 'task2.toml' && fs.readFileSync(file, 'utf8').includes('[[body]]'));
  execFileSync(tumble, ['run', file, '--duration', '0.02', '--out', path.join(folder, 'run')], { stdio: 'ignore' });
  check('and it runs', fs.existsSync(path.join(folder, 'run', 'motion.html')));
}

// two pages look at one simulation
async function second(browser, page, address) {
  // one picture at a time: two are much for a processor
  await page.click('#play');
  await paused('pause again', page);
  const other = await open(browser, address, { viewport: { width: 800, height: 500 } });
  await connected('a second page connects', other);
  await page.click('#play');
  await until('the second page hears that the first plays', other, () => document.querySelector('#play').getAttribute('aria-label') === 'Pause');
  await page.click('#play');
  await paused('the second page hears that the first pauses', other);
  await paused('and so does the first', page);
  const { step } = await film(page);
  await until('both see the same time', other, (s) => tumble.app.film.frames.at(-1).step === s && tumble.app.player.time === tumble.app.film.end, step);
  await slide(other, 'gravity.1', 255);
  await until('a slider of the second moves that of the first', page, () => document.querySelector('.parameter[title="gravity.1"] output').textContent.includes('9.8'));
  // looking back while another begins again
  await page.keyboard.press('ArrowLeft');
  await other.click('#first');
  await until('a page that looked back begins again too', page, () => tumble.app.film.end === 0 && tumble.app.player.time === 0);
  await quiet('the second page', other);
}

async function broken(page, viewer) {
  await page.click('#play');
  await until('it plays', page, () => tumble.app.film.end > 0.3);
  const { port } = viewer;
  await viewer.stop('SIGKILL');
  await until('a broken link is told', page, () => /^(No connection|Connecting)/.test(document.querySelector('#link').textContent));
  await viewer.start('task2', port);
  await connected('the page comes back by itself', page);
  await until('and shows the new run', page, () => tumble.app.film.start < 0.3 && tumble.app.film.end > 0.1 && tumble.app.film.frames.length > 3);
  check('with what the new server knows', (await parameter(page, 'collision.collision_stiffness')) === 1e4);
  const status = await viewer.stop();
  check('Ctrl-C ends the viewer well', status === 0, String(status));
  await viewer.start('slope', port);
  await until('another scene on the same port is another scene', page, () => document.querySelector('#name').textContent === 'slope' && document.querySelector('#link').textContent === 'Connected');
}

async function slope(browser, viewer) {
  const page = await open(browser, viewer.address, { viewport, reducedMotion: 'no-preference' });
  await connected('the slope connects', page);
  await page.click('#first');
  await slide(page, 'collision.friction_stiffness', 800);
  await until('friction comes back from the server', page, () => tumble.app.head.parameters.find(({ key }) => key === 'collision.friction_stiffness').value === 1.6);
  await until('the box loses energy on its way down', page, () => tumble.app.film.frames.at(-1).ledger[4] > 0.01);
  await page.keyboard.press('6');
  await picture(page, 'live-slope');
  await quiet('slope', page);
}

async function finished(browser) {
  const run = path.join(folder, 'finished');
  execFileSync(tumble, ['run', 'task2', '--duration', '0.5', '--out', run], { stdio: 'ignore' });
  const viewer = new Viewer();
  await viewer.start(run);
  const page = await open(browser, viewer.address, { viewport });
  await until('a finished run is served', page, () => window.tumble?.app.film.length === 51);
  await page.keyboard.press('End');
  check('to its end', (await page.evaluate(() => tumble.app.player.time)) === 0.5);
  await quiet('a finished run', page);
  await viewer.stop();
}

const browser = await launch();
try {
  const viewer = new Viewer();
  await viewer.start('task2');
  const page = await open(browser, viewer.address, { viewport });
  await time(page);
  await settings(page);
  await reset(page);
  await speeds(page);
  await drag(page, [-120, -110], 'shift');
  await drag(page, [100, -60], 'button');
  await save(page);
  await second(browser, page, viewer.address);
  check('the live page says nothing', page.said.length === 0, page.said.slice(0, 5).join(' | '));
  await broken(page, viewer);
  // a browser tells of every connection that fails; nothing else
  const rest = page.said.filter((text) => !text.includes('WebSocket connection to'));
  check('but for the connections that failed', rest.length === 0, rest.slice(0, 5).join(' | '));
  await page.context().close();
  await slope(browser, viewer);
  await viewer.stop();
  await finished(browser);
} catch (error) {
  check('the test comes to its end', false, error.message);
} finally {
  await browser.close();
  for (const child of running) child.kill('SIGKILL');
  fs.rmSync(folder, { recursive: true, force: true });
}
finish();
