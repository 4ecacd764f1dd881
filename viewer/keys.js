// All keys, in one table: what they do, and what the help says of them.

import { button, element } from './dom.js';
import { QUANTITIES } from './overlays.js';

// `app` has the actions; `live`: only in a live run, or only without one
export function bindings(app) {
  const toggle = (key) => () => {
    app.shows[key] = !app.shows[key];
    app.changed();
  };
  const topics = {
    Time: [
      { keys: [' '], shown: 'Space', text: 'play, pause', does: () => app.play() },
      { keys: ['ArrowLeft'], shown: '←', text: app.head.live ? 'one frame back' : 'one frame back (Shift: ten)', does: (e) => app.step(e.shiftKey ? -10 : -1) },
      { keys: ['ArrowRight'], shown: '→', text: app.head.live ? 'one step on' : 'one frame on (Shift: ten)', does: (e) => app.step(e.shiftKey ? 10 : 1) },
      { keys: ['Home'], shown: 'Home', text: 'to the start', does: () => app.player.seek(-Infinity) },
      { keys: ['End'], shown: 'End', text: 'to the end', does: () => app.player.seek(Infinity) },
      { keys: ['+', '='], shown: '+', text: 'faster', does: () => app.faster(1) },
      { keys: ['-', '_'], shown: '−', text: 'slower', does: () => app.faster(-1) },
      { keys: ['l'], shown: 'L', text: 'loop', live: false, does: () => app.loop() },
      { keys: ['r'], shown: 'R', text: 'start again', live: true, does: () => app.reset() },
      { keys: ['n'], shown: 'N', text: 'the newest frame', live: true, does: () => app.player.toNow() },
    ],
    Bodies: [
      { keys: ['.'], shown: '.', text: 'select the next body', does: () => app.selectNext(1) },
      { keys: [','], shown: ',', text: 'select the one before', does: () => app.selectNext(-1) },
      { keys: ['Escape'], shown: 'Esc', text: 'select none', does: () => app.select(null) },
      { keys: ['g'], shown: 'G', text: 'drag bodies', live: true, does: () => app.grabMode() },
      { keys: ['s'], shown: 'S', text: 'save the scene', live: true, does: () => app.save() },
      { keys: ['c'], shown: 'C', text: 'follow a body', does: () => app.follow() },
    ],
    View: [
      { keys: ['f'], shown: 'F', text: 'show everything', does: () => app.whole() },
      { keys: ['t'], shown: 'T', text: 'light or dark', does: () => app.switchTheme() },
      { keys: ['b'], shown: 'B', text: 'panel', does: () => app.togglePanel() },
      { keys: ['?'], shown: '?', text: 'this help', does: () => app.help() },
    ],
    Show: [
      { keys: ['m'], shown: 'M', text: 'surfaces', does: toggle('meshes') },
      { keys: ['e'], shown: 'E', text: 'edges', does: toggle('edges') },
      { keys: ['p'], shown: 'P', text: 'particles', does: toggle('particles') },
      { keys: ['h'], shown: 'H', text: 'paths', does: toggle('paths') },
      { keys: ['w'], shown: 'W', text: 'walls', does: toggle('walls') },
      { keys: ['i'], shown: 'I', text: 'inertia ellipsoid', does: () => app.toggleEllipsoid() },
    ],
    Arrows: [
      ...QUANTITIES.map(({ key, label }, index) => ({
        keys: [String(index + 1)], shown: String(index + 1), text: `arrow: ${label.toLowerCase()}`, does: () => app.setArrow(key, !app.overlays.shown.has(key)),
      })),
      { keys: [']'], shown: ']', text: 'longer arrows', does: () => app.setArrowSize(app.overlays.factor * 1.25) },
      { keys: ['['], shown: '[', text: 'shorter arrows', does: () => app.setArrowSize(app.overlays.factor / 1.25) },
    ],
  };
  const all = Object.entries(topics).flatMap(([topic, list]) => list.map((binding) => ({ topic, ...binding })));
  return all.filter(({ live }) => live === undefined || live === app.head.live);
}

const VIEW_KEYS = { ArrowLeft: [0.08, 0], ArrowRight: [-0.08, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08] };

export function listen(app) {
  const table = new Map(bindings(app).flatMap((binding) => binding.keys.map((key) => [key, binding])));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || document.querySelector('dialog[open]')) return;
    if (event.altKey && VIEW_KEYS[event.key]) {
      event.preventDefault();
      app.turnView(...VIEW_KEYS[event.key]);
      return;
    }
    if (event.key === 'PageUp' || event.key === 'PageDown') {
      app.zoomView(event.key === 'PageUp' ? 0.88 : 1.14);
      event.preventDefault();
      return;
    }
    const binding = table.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
    if (event.altKey || !binding || belongsTo(event)) return;
    event.preventDefault();
    binding.does(event);
  });
}

// whether the element in focus needs the key itself
function belongsTo(event) {
  const { target, key } = event;
  const tag = target.tagName;
  const moves = key.startsWith('Arrow') || key === 'Home' || key === 'End';
  if (tag === 'SELECT') return moves || key === ' ' || key.length === 1;
  if (tag === 'BUTTON' || tag === 'SUMMARY' || tag === 'A') return key === ' ';
  if (tag === 'INPUT' && target.type === 'range') return moves && target.id !== 'slider';
  if (tag === 'INPUT') return key === ' ' || moves;
  return false;
}

export function helpDialog(dialog, app) {
  const mouse = [
    ['Drag', 'turn the view'],
    ['Right button', 'move it'],
    ['Two fingers', 'move it'],
    ['Wheel, pinch', 'zoom'],
    ['Click', 'select a body'],
    ...(app.head.live ? [['Shift and drag', 'pull a body along']] : []),
    ['Alt and arrows', 'turn the view'],
    ['Page up, page down', 'zoom'],
  ];
  const rows = (list) => list.flatMap(([key, text]) => [element('dt', {}, ...key.split(', ').map((k) => element('kbd', {}, k))), element('dd', {}, text)]);
  const group = (topic, list) => element('section', {}, element('h3', {}, topic), element('dl', {}, ...rows(list)));
  const keys = bindings(app);
  const topics = [...new Set(keys.map(({ topic }) => topic))];
  const groups = topics.map((of) => group(of, keys.filter(({ topic }) => topic === of).map(({ shown, text }) => [shown, text.replace(/^arrow: /, '')])));
  const close = button('Close (Esc)', 'Close', () => dialog.close(), 'Close');
  dialog.replaceChildren(
    element('div', { className: 'top' }, element('h2', { id: 'help-title' }, 'Keys and mouse'), close),
    element('div', { className: 'columns' }, group('Mouse and touch', mouse), ...groups),
    element('p', { className: 'muted' }, 'Arrows: forces share one scale, each other quantity has its own; point at a row in the panel to read it. An arrow that would leave the picture is cut and says so. The energy plot stacks where the energy is and where it went; the line on top is their sum, the dotted line its value at the start. The numbers are those of energy.csv: gravitational energy is zero at the origin. Only the plot counts it from another zero, and says from which.'),
  );
}
