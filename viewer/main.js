// Where the page begins: with a run inside it, or with a server to ask.

import { App } from './app.js';
import { Controls } from './controls.js';
import { Film, bytesOfBase64 } from './data.js';
import { Grab } from './grab.js';
import { Live } from './live.js';
import { byId, download } from './dom.js';
import { listen } from './keys.js';

function fail(text) {
  const missing = byId('missing');
  missing.textContent = text;
  missing.hidden = false;
}

let noticeTimer = 0;
function notice(text) {
  byId('notice').textContent = text;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => (byId('notice').textContent = ''), 6000);
}

function begin(app) {
  app.listen();
  listen(app);
  window.tumble = app.api();
}

// a run that is over
function startRecorded(app, node) {
  const head = JSON.parse(node.textContent);
  const frames = byId('tumble-frames');
  const film = Film.ofBytes(bytesOfBase64(frames.textContent), head.bodies.length);
  // the text of the frames has served
  frames.remove();
  app.build(head, film);
  begin(app);
  if (!app.calm && film.length > 1) app.player.play();
}

// whether two heads are drawn by the same scene
function sameBodies(a, b) {
  const shape = ({ shapes, bodies, walls, box }) =>
    JSON.stringify([shapes, bodies.map(({ name, shape: of }) => [name, of]), walls.map(({ normal, offset }) => [normal, offset]), box]);
  return a !== null && shape(a) === shape(b);
}

function startLive(app) {
  let raw = null;
  let controls = null;
  let fresh = false;
  const send = (message) => {
    if (!link.send(message)) notice('There is no connection; nothing was sent.');
  };
  const hears = {
    link: (state, seconds) => {
      document.body.dataset.link = state;
      app.setConnected(state === 'open');
      if (state === 'open') fresh = true;
      if (controls) controls.link(state, seconds);
      else if (state === 'closed') fail(`No connection to the simulation yet; trying again in ${seconds} s.`);
      else if (state === 'connecting') fail('Connecting to the simulation …');
      else byId('missing').hidden = true;
    },
    head: (head) => {
      const first = raw === null;
      if (sameBodies(raw, head)) {
        // another server, or one that went on unseen: no line leads from the last frame to the next
        if (fresh) app.film.clear();
        app.softHead(head);
      } else {
        app.build(head, null);
        controls = new Controls(byId('live'), { set: (key, value) => send({ type: 'set', key, value }), save: () => app.save(), grab: () => app.grabMode() });
        controls.link('open', 0);
      }
      raw = head;
      fresh = false;
      controls.parameters(head.parameters ?? [], head.bodies);
      if (first) begin(app);
    },
    frame: (buffer) => raw && app.liveFrame(buffer),
    status: (status) => {
      controls?.status(status);
      if (raw) app.liveStatus(status);
    },
    saved: (toml) => {
      const name = `${raw?.name ?? 'scene'}.toml`;
      download(name, toml);
      // the newest state, whatever moment is shown
      const time = toml.match(/^#.* at t = (\S+) s\.$/m)?.[1];
      const at = time === undefined ? app.film.end : Number(time);
      notice(`saved as of t = ${Number(at.toPrecision(9))} s to ${name}`);
    },
    refused: (why) => {
      notice(`Not done: ${why}`);
      if (raw) controls?.settle(raw.parameters ?? [], raw.bodies);
    },
  };
  const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  let link = { send: () => false, status: { playing: false } };
  link = new Live(`${scheme}//${location.host}/live`, hears);
  app.link = {
    send,
    get status() {
      return link.status;
    },
    toggle: () => {
      app.player.toNow();
      send({ type: link.status.playing ? 'pause' : 'play' });
    },
  };
  app.grab = new Grab(send);
}

function start() {
  const node = byId('tumble-head');
  try {
    const app = new App();
    if (node) startRecorded(app, node);
    else if (location.protocol.startsWith('http')) startLive(app);
    else fail('There is no run in this page. "tumble run" writes a motion.html with one; "tumble view" shows a live one.');
  } catch (error) {
    fail(`The run cannot be shown: ${error.message}`);
    throw error;
  }
}

start();
