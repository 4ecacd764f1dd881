// Entry point of the page: shows the run embedded in the page, or connects to the server of a live run.
//
// Data flow: Connection (live) or the data in the page -> Recording (all frames) -> Player (displayed time) ->
// Snapshot (the bodies at that time) -> Renderer, Panel, EnergyPlot. Commands of a live run go the other way:
// App or LiveControls -> Connection -> server. README.md in this folder lists the files and the steps to add a slider.

import { App } from './app.js';
import { Connection } from './connection.js';
import { byId, download } from './dom.js';
import { listenToKeys } from './keyboard.js';
import { LiveControls } from './live_controls.js';
import { MouseSpring } from './mouse_spring.js';
import { Recording, decodeBase64 } from './recording.js';

// shows a message in place of the scene
function showMessage(text) {
  const message = byId('message');
  message.textContent = text;
  message.hidden = false;
}

let noticeTimer = 0;
// shows a notice for a few seconds
function notify(text) {
  byId('notice').textContent = text;
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => (byId('notice').textContent = ''), 6000);
}

function listen(app) {
  app.listen();
  listenToKeys(app);
  window.tumble = app.api();
}

// a finished run, whose data are in the page
function startRecorded(app, headerNode) {
  const header = JSON.parse(headerNode.textContent);
  const framesNode = byId('tumble-frames');
  const recording = Recording.fromBytes(decodeBase64(framesNode.textContent), header.bodies.length, header.joints.length);
  // frees the memory of the base64 text
  framesNode.remove();
  app.build(header, recording);
  listen(app);
  if (!app.reducedMotion && recording.length > 1) app.player.play();
}

// whether two headers have the same shapes, bodies, joints, walls and box
function haveSameScene(a, b) {
  const scene = ({ shapes, bodies, joints, walls, box }) =>
    JSON.stringify([shapes, bodies.map(({ name, shape }) => [name, shape]), joints, walls.map(({ normal, offset }) => [normal, offset]), box]);
  return a !== null && scene(a) === scene(b);
}

function startLive(app) {
  let header = null;
  let controls = null;
  // whether the next header is the first of its connection
  let isNewConnection = false;
  const send = (message) => {
    if (!connection.send(message)) notify('Not connected: nothing was sent.');
  };
  const handlers = {
    state: (state, seconds) => {
      document.body.dataset.connection = state;
      app.setConnected(state === 'open');
      if (state === 'open') isNewConnection = true;
      if (controls) controls.connection(state, seconds);
      else if (state === 'closed') showMessage(`No connection to the simulation; retrying in ${seconds} s.`);
      else if (state === 'connecting') showMessage('Connecting to the simulation …');
      else byId('message').hidden = true;
    },
    header: (newHeader) => {
      const isFirst = header === null;
      if (haveSameScene(header, newHeader)) {
        // frames were missed, or it is another server: paths must not connect old and new frames
        if (isNewConnection) app.recording.clear();
        app.updateHeader(newHeader);
      } else {
        app.build(newHeader, null);
        controls = new LiveControls(byId('live'), { set: (key, value) => send({ type: 'set', key, value }), save: () => app.save(), toggleDragMode: () => app.toggleDragMode() });
        controls.connection('open', 0);
      }
      header = newHeader;
      isNewConnection = false;
      controls.parameters(header.parameters ?? [], header.bodies);
      controls.integrators(header.integrators ?? [], header.integrator);
      if (isFirst) listen(app);
    },
    frame: (buffer) => header && app.addFrame(buffer),
    status: (status) => {
      controls?.status(status);
      if (header) app.updateStatus(status);
    },
    saved: (toml) => {
      const name = `${header?.name ?? 'scene'}.toml`;
      download(name, toml);
      // the saved state is the latest one, whatever time is displayed
      const time = toml.match(/^#.* at t = (\S+) s\.$/m)?.[1];
      const at = time === undefined ? app.recording.end : Number(time);
      notify(`State at t = ${Number(at.toPrecision(9))} s saved to ${name}`);
    },
    refused: (reason) => {
      notify(`Refused: ${reason}`);
      if (header) controls?.restore(header.parameters ?? [], header.bodies);
    },
  };
  const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  // the constructor already calls `handlers`
  let connection = { send: () => false, status: { playing: false } };
  connection = new Connection(`${scheme}//${location.host}/live`, handlers);
  app.connection = {
    send,
    get status() {
      return connection.status;
    },
    toggle: () => {
      app.player.toLatest();
      send({ type: connection.status.playing ? 'pause' : 'play' });
    },
  };
  app.mouseSpring = new MouseSpring(send);
}

function start() {
  const headerNode = byId('tumble-head');
  try {
    const app = new App();
    if (headerNode) startRecorded(app, headerNode);
    else if (location.protocol.startsWith('http')) startLive(app);
    else showMessage('This page contains no run. "tumble run" writes a motion.html with one; "tumble view" shows a live simulation.');
  } catch (error) {
    showMessage(`The run cannot be shown: ${error.message}`);
    throw error;
  }
}

start();
