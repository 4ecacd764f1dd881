// Tests of motion.html and of the live page (with a fake server) in a real browser.
//
//   node page.mjs RUNS [PICTURES] [PART]
//
// RUNS contains folders of runs. Screenshots are written to PICTURES if given. PART selects a single test.

import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { check, closeSilent, finish, launch, open, until } from './browser.mjs';

const [, , runs, pictures] = process.argv;

const recorded = (scene) => pathToFileURL(path.join(runs, scene, 'motion.html')).href;
const time = (page) => page.evaluate(() => tumble.app.player.time);
const screenshot = (page, name) => pictures && page.screenshot({ path: path.join(pictures, `${name}.png`) });

// the position of the first body in trajectory.csv at a time
function positionAt(scene, at) {
  const [, ...lines] = fs.readFileSync(path.join(runs, scene, 'trajectory.csv'), 'utf8').trim().split('\n');
  const rows = lines.map((line) => line.split(','));
  return rows.find((columns) => Math.abs(Number(columns[0]) - at) < 1e-9).slice(2, 5).map(Number);
}

async function drawing(browser) {
  const page = await open(browser, recorded('task2'));
  await until('the page starts', page, () => window.tumble !== undefined);
  await page.evaluate(() => tumble.seek(1));
  const shown = await page.evaluate(() => {
    tumble.pixel(0, 0);
    return tumble.position(0);
  });
  const expected = positionAt('task2', 1);
  check('the position is that of trajectory.csv', shown.every((x, i) => Math.abs(x - expected[i]) < 1e-6), `${shown} and ${expected}`);
  // the body is blue; compare the pixel at its projected position with one beside it
  const colours = await page.evaluate(() => {
    const [x, y] = tumble.project(0);
    return { on: tumble.pixel(x, y), off: tumble.pixel(x - 260, y), corner: tumble.pixel(5, 500) };
  });
  const blue = ([r, , b]) => b > r + 40;
  check('the body is drawn', blue(colours.on) && !blue(colours.off), JSON.stringify(colours));
  check('the background is drawn', colours.corner.some((x) => x > 0), JSON.stringify(colours.corner));
  await page.keyboard.press('m');
  const hidden = await page.evaluate(() => tumble.pixel(...tumble.project(0)));
  check('M hides the surfaces', !blue(hidden), JSON.stringify(hidden));
  await page.keyboard.press('m');
  await screenshot(page, 'task2');
  await closeSilent('task2', page);
}

async function names(browser) {
  const page = await open(browser, recorded('names'));
  await until('the page starts', page, () => window.tumble !== undefined);
  const found = await page.evaluate(() => ({
    scene: document.querySelector('#name').textContent,
    title: document.title,
    bodies: tumble.app.header.bodies.map(({ name }) => name),
    shown: [...document.querySelectorAll('[role=rowheader]')].map((cell) => cell.textContent),
    elements: document.querySelectorAll('img, script').length,
  }));
  const scene = '<img src=x onerror=alert(1)> & <!--';
  check('the name of the scene is text', found.scene === scene && found.title === `${scene} – tumble`, JSON.stringify(found));
  check('the names of bodies are text', found.shown.length > 0 && found.shown.every((name) => found.bodies.includes(name)), JSON.stringify(found));
  const plain = await open(browser, recorded('task2'));
  check('names add no elements', (await plain.evaluate(() => document.querySelectorAll('img, script').length)) === found.elements);
  await plain.context().close();
  await closeSilent('names', page);
}

async function playing(browser) {
  const page = await open(browser, recorded('task2'));
  await page.click('#play');
  await until('play advances the time', page, () => tumble.app.player.time > 0.2);
  await page.click('#play');
  const stopped = await time(page);
  await page.waitForTimeout(300);
  check('pause stops it', (await time(page)) === stopped);
  await page.evaluate(() => tumble.seek(1));
  await page.keyboard.press('ArrowRight');
  check('→ is one frame forward', Math.abs((await time(page)) - 1.01) < 1e-9, String(await time(page)));
  await page.click('#back');
  await page.click('#back');
  check('two clicks back are two frames back', Math.abs((await time(page)) - 0.99) < 1e-9, String(await time(page)));
  await page.keyboard.press('End');
  check('End goes to the end', (await time(page)) === 3);
  await page.keyboard.press('Home');
  check('Home goes to the start', (await time(page)) === 0);
  const slider = await page.locator('#slider').boundingBox();
  await page.mouse.click(slider.x + slider.width / 2, slider.y + slider.height / 2);
  check('the slider scrubs', Math.abs((await time(page)) - 1.5) < 0.1, String(await time(page)));
  // on a busy machine the layout may still change between measuring and clicking
  for (let attempt = 0; attempt < 3 && Math.abs((await time(page)) - 0.75) >= 0.02; attempt++) {
    const plot = await page.locator('#plot .area').boundingBox();
    await page.mouse.click(plot.x + 58 + (plot.width - 68) * 0.25, plot.y + 40);
  }
  check('the plot scrubs', Math.abs((await time(page)) - 0.75) < 0.02, String(await time(page)));
  check('the plot shows values', (await page.locator('.tip').innerText()).includes('Kinetic'));
  await page.keyboard.press('l');
  await page.evaluate(() => tumble.seek(2.9));
  await page.keyboard.press('Space');
  await until('a loop starts again', page, () => tumble.app.player.time < 2.5);
  await page.keyboard.press('Space');
  await closeSilent('playing', page);
}

async function panel(browser) {
  const page = await open(browser, recorded('many'));
  await page.evaluate(() => tumble.seek(0.7));
  const at = await page.evaluate(() => {
    tumble.pixel(0, 0);
    // the free body nearest to the eye is not hidden by others
    const { app } = tumble;
    const eye = app.view().eye;
    const distance = (i) => Math.hypot(...app.snapshot.position(i).map((x, k) => x - eye[k]));
    const nearest = app.header.bodies.map((_, i) => i).filter((i) => i >= 18).sort((a, b) => distance(a) - distance(b))[0];
    const [x, y] = tumble.project(nearest);
    return { nearest, x, y };
  });
  let chosen = null;
  // the centre of a torus is a hole: try points around it too
  for (const [dx, dy] of [[0, 0], [14, 0], [-14, 0], [0, 14], [0, -14], [10, 10]]) {
    await page.mouse.click(at.x + dx, at.y + dy);
    chosen = await page.evaluate(() => tumble.app.selected);
    if (chosen !== null) break;
  }
  check('a click selects a body', chosen !== null, `${chosen}`);
  check('its row is marked', (await page.locator('.row[aria-selected="true"]').count()) === 1);
  for (const key of ['1', '2', '3', '4', '5', '6', '7', 'i', 'e', 'p']) await page.keyboard.press(key);
  await until('arrows have labels', page, () => document.querySelectorAll('#labels span:not([hidden])').length >= 2);
  await page.keyboard.press('c');
  check('C follows the body', await page.evaluate(() => tumble.app.following === tumble.app.selected));
  await page.locator('.scroll').focus();
  await page.keyboard.press('End');
  check('keys select in the table', (await page.evaluate(() => tumble.app.selected)) === 35);
  await page.keyboard.press('?');
  check('? opens the help', await page.locator('#help').isVisible());
  await page.keyboard.press('Escape');
  check('Escape closes it', !(await page.locator('#help').isVisible()));
  await page.keyboard.press('t');
  check('T switches to the dark theme', (await page.evaluate(() => document.documentElement.dataset.theme)) === 'dark');
  await page.keyboard.press('b');
  check('B hides the panel', !(await page.locator('#panel').isVisible()));
  await screenshot(page, 'many-dark');
  await closeSilent('panel', page);
}

async function views(browser) {
  const page = await open(browser, recorded('task2-cat'));
  await page.evaluate(() => tumble.seek(0.4));
  const before = await page.evaluate(() => tumble.project(0));
  await page.mouse.move(400, 300);
  await page.mouse.down();
  await page.mouse.move(520, 340, { steps: 4 });
  await page.mouse.up();
  const turned = await page.evaluate(() => tumble.project(0));
  check('dragging rotates the view', Math.hypot(turned[0] - before[0], turned[1] - before[1]) > 5);
  const distance = () => page.evaluate(() => tumble.app.camera.distance);
  const far = await distance();
  await page.mouse.wheel(0, -300);
  await page.waitForTimeout(50);
  check('the wheel zooms', (await distance()) < far);
  await page.keyboard.press('f');
  await page.setViewportSize({ width: 900, height: 600 });
  await page.waitForTimeout(200);
  const inside = await page.evaluate(() => {
    const { width, height } = tumble.app.canvas.getBoundingClientRect();
    return [width, height, ...tumble.project(0)];
  });
  check('the body stays visible in a smaller window', inside[0] === 900 && inside[1] === 600 && inside[2] > 0 && inside[2] < 900, String(inside));
  await closeSilent('views', page);
}

async function phone(browser) {
  const options = { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true, colorScheme: 'dark' };
  const page = await open(browser, recorded('task2-cat'), options);
  check('the page follows the dark colour scheme', (await page.evaluate(() => document.documentElement.dataset.theme)) === 'dark');
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  check('nothing is wider than the screen', wide <= 360, String(wide));
  const outside = await page.evaluate(() =>
    [...document.querySelectorAll('button, select, input')]
      .filter((node) => node.checkVisibility() && !node.closest('dialog') && (node.getBoundingClientRect().right > 361 || node.getBoundingClientRect().left < 0))
      .map((node) => node.id || node.title),
  );
  check('all controls are on the screen', outside.length === 0, outside.join(', '));
  await page.tap('#panel-toggle');
  check('the panel opens', await page.locator('#panel').isVisible());
  await page.tap('#panel-toggle');
  await page.tap('#play');
  await until('a tap plays', page, () => tumble.app.player.time > 0.05);
  await screenshot(page, 'phone');
  await closeSilent('phone', page);
}

async function autoplay(browser) {
  for (const scene of ['racket', 'slope']) {
    const page = await open(browser, recorded(scene), { reducedMotion: 'no-preference' });
    await until(`${scene} starts to play`, page, () => window.tumble?.app.player.time > 0.1);
    await page.keyboard.press('6');
    await page.waitForTimeout(200);
    await screenshot(page, scene);
    await closeSilent(scene, page);
  }
}

async function manyBodies(browser) {
  const page = await open(browser, recorded('thousand'));
  const rows = await page.locator('.rows .row').count();
  check('only visible rows of a thousand exist', rows > 3 && rows < 40, String(rows));
  await page.keyboard.press('Space');
  await until('a thousand bodies play', page, () => tumble.app.player.time > 0.2);
  await screenshot(page, 'thousand');
  await closeSilent('thousand', page);
}

async function accessibility(browser) {
  const page = await open(browser, recorded('task2'));
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('button, input, select, canvas')]
      .filter((node) => !(node.getAttribute('aria-label') || node.labels?.length || node.textContent.trim()))
      .map((node) => node.outerHTML.slice(0, 80)),
  );
  check('every control has an accessible name', nameless.length === 0, nameless.join(' | '));
  const seen = new Set();
  for (let i = 0; i < 40; i++) {
    await page.keyboard.press('Tab');
    seen.add(await page.evaluate(() => document.activeElement.id));
  }
  check('Tab reaches play, slider, arrows', ['play', 'slider', 'arrow-angularMomentum'].every((id) => seen.has(id)), [...seen].join(' '));
  await closeSilent('accessibility', page);
}

// without WebGL2 the page says so and still shows the numbers
async function withoutWebgl(browser) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce' });
  const page = await context.newPage();
  page.messages = [];
  page.on('pageerror', (error) => page.messages.push(`error: ${error.message}`));
  await page.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind === 'webgl2' ? null : original.call(this, kind, ...rest);
    };
  });
  await page.goto(recorded('task2'));
  check('a message says that WebGL2 is missing', (await page.locator('#message').innerText()).includes('WebGL2'));
  await page.evaluate(() => tumble.seek(1));
  await page.waitForTimeout(100);
  check('energies are shown', (await page.locator('.legend').innerText()).includes('J'));
  check('bodies are listed', (await page.locator('#body-0').innerText()).includes('ball'));
  await closeSilent('without WebGL2', page);
}

// the state of a joint in joints.csv at a time
function jointAt(scene, name, at) {
  const [, ...lines] = fs.readFileSync(path.join(runs, scene, 'joints.csv'), 'utf8').trim().split('\n');
  const columns = lines.map((line) => line.split(',')).find(([time, joint]) => joint === name && Math.abs(Number(time) - at) < 1e-9);
  const [fx, fy, fz, tx, ty, tz, coordinate, rate] = columns.slice(2).map(Number);
  return { force: Math.hypot(fx, fy, fz), torque: Math.hypot(tx, ty, tz), coordinate, rate };
}

// the numbers that the panel shows of the selected joint, by their labels
const shownValues = (page) => page.evaluate(() => {
  const read = (node) => parseFloat(node.textContent.replaceAll('\u2009', '').replace('−', '-'));
  return Object.fromEntries([...document.querySelectorAll('#joint-detail dt')].map((dt) => [dt.firstChild.textContent, read(dt.nextSibling)]));
});

const hasNumbers = () => ![undefined, ''].includes(document.querySelector('#joint-detail dd')?.textContent);

async function joints(browser) {
  const page = await open(browser, recorded('slider-crank'));
  await until('the page starts', page, () => window.tumble !== undefined);
  const at = await page.evaluate(() => {
    const { time } = tumble.app.recording.frames[40];
    tumble.seek(time);
    return time;
  });
  check('joints can be hidden', await page.locator('#show-joints').isChecked());
  check('joints are listed', (await page.locator('#joints .rows .row').count()) === 4);
  for (const [row, name] of [[0, 'bearing'], [3, 'cylinder']]) {
    await page.click(`#joint-${row}`);
    await until(`${name} has numbers`, page, hasNumbers);
    const shown = await shownValues(page);
    const expected = jointAt('slider-crank', name, at);
    const pairs = [[shown['|F|'], expected.force], [shown[row ? 'Displacement' : 'Angle'], expected.coordinate], [shown.Rate, expected.rate]];
    if (row === 0) pairs.push([shown['|τ|'], expected.torque]);
    check(`the numbers of ${name} are those of joints.csv`, pairs.every(([a, b]) => Math.abs(a - b) < 2e-3 * Math.abs(b)), JSON.stringify({ shown, expected }));
  }
  await page.selectOption('#joint-course', 'coordinate');
  const plot = await page.locator('#joint-detail .area').boundingBox();
  await page.mouse.click(plot.x + 58 + (plot.width - 68) * 0.5, plot.y + 40);
  check('the plot of a joint scrubs', Math.abs((await time(page)) - 2.5) < 0.03, String(await time(page)));
  check('it shows values', / m$/.test(await page.locator('#joint-detail .tip').innerText()) || (await page.locator('#joint-detail .tip').innerText()).includes('\u202fm'));
  // the selected joint is drawn in its own colour: some pixels change when joints are hidden
  const image = () => page.evaluate(() => {
    const { app } = tumble;
    const [x, y] = app.camera.project(app.view(), [0, 0, 0.03]);
    return tumble.pixel(x, y);
  });
  const drawn = await image();
  await page.keyboard.press('j');
  const hidden = await image();
  check('J hides the joints', !(await page.locator('#show-joints').isChecked()) && String(drawn) !== String(hidden), `${drawn} and ${hidden}`);
  await page.keyboard.press('j');
  await screenshot(page, 'slider-crank');
  await page.keyboard.press('Escape');
  check('Escape clears the selected joint', (await page.evaluate(() => tumble.app.selectedJoint)) === null && !(await page.locator('#joint-detail').isVisible()));
  await closeSilent('joints', page);
  const plain = await open(browser, recorded('task2'));
  const found = await plain.evaluate(() => [...document.querySelectorAll('#show-joints, #joints')].length);
  check('without joints there is neither toggle nor list', found === 0);
  await plain.keyboard.press('?');
  check('nor a key', !(await plain.locator('#help').innerText()).includes('joints'));
  await closeSilent('without joints', plain);
}

// joints of a live run: numbers and plot follow the frames
async function liveJoints(browser) {
  const server = await fakeServer('slider-crank');
  const page = await open(browser, `http://127.0.0.1:${server.port}/`);
  await until('frames with joints arrive', page, () => window.tumble?.app.recording.length > 5);
  await page.click('#joint-1');
  await until('the joint has numbers', page, hasNumbers);
  const before = (await shownValues(page))['|F|'];
  await page.waitForTimeout(600);
  const after = await shownValues(page);
  check('the force of a joint follows the frames', before >= 5 && after['|F|'] > before && after['|τ|'] === 1, JSON.stringify({ before, after }));
  check('its plot too', (await page.evaluate(() => tumble.app.jointList.plot.points().length)) > 10);
  await closeSilent('live joints', page);
  await server.close();
}

// a fake of the live server with the header of a recorded run
async function fakeServer(scene) {
  const { FakeServer } = await import('./live-server.mjs');
  const file = fs.readFileSync(path.join(runs, scene, 'motion.html'), 'utf8');
  const head = JSON.parse(file.match(/id="tumble-head">([^<]*)</)[1]);
  const html = file.replace(/<script type="application\/json"[^]*?<\/script>\s*<script type="text\/plain"[^]*?<\/script>/, '').replace("connect-src 'none'", "connect-src 'self' ws: wss:");
  const server = new FakeServer(html, head);
  await server.open();
  return server;
}

async function live(browser) {
  const server = await fakeServer('task2');
  const page = await open(browser, `http://127.0.0.1:${server.port}/`);
  const received = (type) => server.received.filter((message) => message.type === type);
  await until('frames arrive', page, () => window.tumble?.app.recording.length > 5);
  check('the connection is shown', (await page.locator('#connection').innerText()) === 'Connected');
  await page.click('#play');
  await until('pause is sent and confirmed', page, () => document.querySelector('#play').getAttribute('aria-label') === 'Play');
  await page.keyboard.press('ArrowRight');
  await page.waitForTimeout(200);
  check('a step is sent', received('step').length === 1, JSON.stringify(server.received));
  const slider = page.locator('.parameter input').first();
  await slider.fill('800');
  await page.waitForTimeout(100);
  const [set] = received('set').slice(-1);
  check('a logarithmic slider sets its parameter', set?.key === 'collision.collision_stiffness' && Math.abs(set.value - 1e6) < 1e3, JSON.stringify(set));
  await page.locator('.parameter input').nth(2).fill('500');
  await until('a pending parameter is marked', page, () => document.querySelector('.parameter[data-pending="true"]')?.textContent.includes('waiting'));
  await page.click('#first');
  await until('a reset starts again', page, () => !document.querySelector('.parameter[data-pending="true"]') && tumble.app.recording.length < 3);
  const [x, y] = await page.evaluate(() => tumble.project(0));
  await page.keyboard.down('Shift');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y - 40, { steps: 5 });
  await screenshot(page, 'live-drag');
  await page.waitForTimeout(100);
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await page.waitForTimeout(200);
  const [attach] = received('grab');
  check('a body is dragged and released', attach?.body === 0 && Number.isInteger(attach.particle) && received('move').length > 0 && received('release').length === 1, JSON.stringify(server.received.slice(-4)));
  const saving = page.waitForEvent('download');
  await page.click('#save');
  const saved = await saving;
  check('saving downloads a file', saved.suggestedFilename() === 'task2.toml');
  check('a notice gives the time of the saved state', /State at t = .* s saved to task2\.toml/.test(await page.locator('#notice').innerText()));
  await page.selectOption('#speed', '0.25');
  await page.waitForTimeout(100);
  check('speed is sent', received('speed').at(-1)?.value === 0.25);
  check('the live page has no console messages', page.messages.length === 0, page.messages.join(' | '));
  const { port } = server;
  await server.close();
  await until('a lost connection is shown', page, () => document.querySelector('#connection').textContent.startsWith('No connection'));
  check('also in the title', (await page.locator('#facts').innerText()).includes('not connected'));
  await server.open(port);
  await until('the page reconnects', page, () => document.querySelector('#connection').textContent === 'Connected');
  await page.context().close();
  await server.close();
}

const only = process.argv[4];
const browser = await launch();
try {
  for (const part of [drawing, names, playing, panel, views, phone, autoplay, manyBodies, joints, accessibility, withoutWebgl, live, liveJoints]) {
    if (only && part.name !== only) continue;
    console.log(`\n${part.name}`);
    await part(browser);
  }
} finally {
  await browser.close();
}
finish();
