// The key bindings, and the help dialog that lists them.

import { button, element } from './dom.js';
import { hasJointLayer, jointLayerLabel } from './joints.js';
import { QUANTITIES } from './overlays.js';

// The bindings for a run: `keys` as in KeyboardEvent.key, the key shown in the help, the help text and the action.
// Bindings with `live` are for live runs only (true) or finished runs only (false).
export function bindings(app) {
  const toggle = (key) => () => {
    app.layers[key] = !app.layers[key];
    app.changed();
  };
  const topics = {
    Time: [
      { keys: [' '], label: 'Space', text: 'play or pause', action: () => app.play() },
      { keys: ['ArrowLeft'], label: '←', text: app.header.live ? 'one frame back' : 'one frame back (Shift: ten)', action: (e) => app.step(e.shiftKey ? -10 : -1) },
      { keys: ['ArrowRight'], label: '→', text: app.header.live ? 'one step forward' : 'one frame forward (Shift: ten)', action: (e) => app.step(e.shiftKey ? 10 : 1) },
      { keys: ['Home'], label: 'Home', text: 'go to the start', action: () => app.player.seek(-Infinity) },
      { keys: ['End'], label: 'End', text: 'go to the end', action: () => app.player.seek(Infinity) },
      { keys: ['+', '='], label: '+', text: 'faster', action: () => app.changeSpeed(1) },
      { keys: ['-', '_'], label: '−', text: 'slower', action: () => app.changeSpeed(-1) },
      { keys: ['l'], label: 'L', text: 'loop on or off', live: false, action: () => app.loop() },
      { keys: ['r'], label: 'R', text: 'reset to t = 0', live: true, action: () => app.reset() },
      { keys: ['n'], label: 'N', text: 'go to the latest frame', live: true, action: () => app.player.toLatest() },
    ],
    Bodies: [
      { keys: ['.'], label: '.', text: 'select the next body', action: () => app.selectNext(1) },
      { keys: [','], label: ',', text: 'select the previous body', action: () => app.selectNext(-1) },
      { keys: ['Escape'], label: 'Esc', text: 'clear the selection', action: () => app.clearSelection() },
      { keys: ['g'], label: 'G', text: 'drag mode on or off', live: true, action: () => app.toggleDragMode() },
      { keys: ['s'], label: 'S', text: 'save as scene file', live: true, action: () => app.save() },
      { keys: ['c'], label: 'C', text: 'camera follows the body', action: () => app.follow() },
    ],
    View: [
      { keys: ['f'], label: 'F', text: 'show everything', action: () => app.showAll() },
      { keys: ['t'], label: 'T', text: 'light or dark theme', action: () => app.switchTheme() },
      { keys: ['b'], label: 'B', text: 'panel on or off', action: () => app.togglePanel() },
      { keys: ['?'], label: '?', text: 'this help', action: () => app.help() },
    ],
    Show: [
      { keys: ['m'], label: 'M', text: 'surfaces', action: toggle('meshes') },
      { keys: ['e'], label: 'E', text: 'edges', action: toggle('edges') },
      { keys: ['p'], label: 'P', text: 'particles', action: toggle('particles') },
      { keys: ['h'], label: 'H', text: 'paths', action: toggle('paths') },
      { keys: ['w'], label: 'W', text: 'walls', action: toggle('walls') },
      ...(hasJointLayer(app.header) ? [{ keys: ['j'], label: 'J', text: jointLayerLabel(app.header).toLowerCase(), action: toggle('joints') }] : []),
      { keys: ['i'], label: 'I', text: 'inertia ellipsoid', action: () => app.toggleEllipsoid() },
    ],
    Arrows: [
      ...QUANTITIES.map(({ key, label: name }, index) => ({
        keys: [String(index + 1)], label: String(index + 1), text: `arrow: ${name.toLowerCase()}`, action: () => app.setArrow(key, !app.overlays.shown.has(key)),
      })),
      { keys: [']'], label: ']', text: 'longer arrows', action: () => app.setArrowSize(app.overlays.factor * 1.25) },
      { keys: ['['], label: '[', text: 'shorter arrows', action: () => app.setArrowSize(app.overlays.factor / 1.25) },
    ],
  };
  const all = Object.entries(topics).flatMap(([topic, list]) => list.map((binding) => ({ topic, ...binding })));
  return all.filter(({ live }) => live === undefined || live === app.header.live);
}

const VIEW_KEYS = { ArrowLeft: [0.08, 0], ArrowRight: [-0.08, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08] };

export function listenToKeys(app) {
  const byKey = new Map(bindings(app).flatMap((binding) => binding.keys.map((key) => [key, binding])));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || document.querySelector('dialog[open]')) return;
    if (event.altKey && VIEW_KEYS[event.key]) {
      event.preventDefault();
      app.orbitView(...VIEW_KEYS[event.key]);
      return;
    }
    if (event.key === 'PageUp' || event.key === 'PageDown') {
      app.zoomView(event.key === 'PageUp' ? 0.88 : 1.14);
      event.preventDefault();
      return;
    }
    const binding = byKey.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
    if (event.altKey || !binding || isHandledByTarget(event)) return;
    event.preventDefault();
    binding.action(event);
  });
}

// whether the focused element uses the key itself
function isHandledByTarget(event) {
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
    ['Drag', 'rotate the view'],
    ['Right drag', 'pan'],
    ['Two fingers', 'pan'],
    ['Wheel, pinch', 'zoom'],
    ['Click', 'select a body'],
    ...(app.header.live ? [['Shift + drag', 'drag a body']] : []),
    ['Alt + arrows', 'rotate the view'],
    ['Page up, Page down', 'zoom'],
  ];
  const rows = (list) => list.flatMap(([key, text]) => [element('dt', {}, ...key.split(', ').map((k) => element('kbd', {}, k))), element('dd', {}, text)]);
  const group = (topic, list) => element('section', {}, element('h3', {}, topic), element('dl', {}, ...rows(list)));
  const keys = bindings(app);
  const topics = [...new Set(keys.map(({ topic }) => topic))];
  const groups = topics.map((name) => group(name, keys.filter(({ topic }) => topic === name).map(({ label, text }) => [label, text.replace(/^arrow: /, '')])));
  const close = button('Close (Esc)', 'Close', () => dialog.close(), 'Close');
  dialog.replaceChildren(
    element('div', { className: 'top' }, element('h2', { id: 'help-title' }, 'Keys and mouse'), close),
    element('div', { className: 'columns' }, group('Mouse and touch', mouse), ...groups),
    element('p', { className: 'muted' }, 'Arrows: all forces share one scale, every other quantity has its own; hover over a row of the panel to read the scale. An arrow that is too long is cut off and labelled (cut). Fˡ and τˡ are force and torque of a load, Fʲ is the force of the selected joint on its first body. Energy plot: the stacked areas are the stored and the dissipated energy, the solid line is their sum, the dotted line is the sum at the start. The numbers are those of energy.csv, with gravitational energy zero at the origin; only the plot uses another zero, which it states.'),
  );
}
