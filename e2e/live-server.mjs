// A fake of the live server: serves the page, sends a header and frames over /live, and records what it receives.

import http from 'node:http';
import { createRequire } from 'node:module';
import path from 'node:path';

const { WebSocketServer } = createRequire(path.join(import.meta.dirname, '.tools', 'here.js'))('ws');

const LEDGER_BYTES = 104;
const BODY_FLOATS = 22;
const JOINT_FLOATS = 8;

// one frame: bodies on circles, joints with a force of 5 N at the start, and a consistent energy ledger
function frame(time, step, { bodies: { length: bodyCount }, joints: { length: jointCount } }) {
  const jointsAt = LEDGER_BYTES + 4 * BODY_FLOATS * bodyCount;
  const buffer = new ArrayBuffer(jointsAt + 4 * JOINT_FLOATS * jointCount);
  const kinetic = 5 + 5 * Math.cos(time);
  new Float64Array(buffer, 0, 13).set([time, step, kinetic, 10 - kinetic, 0, 0, 0, 0, 0, 0, 0, 10, 0]);
  for (let body = 0; body < bodyCount; body++) {
    const angle = time + body;
    const floats = new Float32Array(buffer, LEDGER_BYTES + 4 * BODY_FLOATS * body, BODY_FLOATS);
    floats.set([0.5 * Math.cos(angle), 0, 0.5 * Math.sin(angle), Math.cos(angle / 2), 0, Math.sin(angle / 2), 0]);
    floats.set([0, 0, 0, 0, 1, 0, 0, 2, 0], 7);
  }
  for (let joint = 0; joint < jointCount; joint++) {
    const floats = new Float32Array(buffer, jointsAt + 4 * JOINT_FLOATS * joint, JOINT_FLOATS);
    floats.set([3 + time, 4, 0, 0, 0, joint, time, 1]);
  }
  return buffer;
}

export class FakeServer {
  constructor(html, recordedHeader) {
    this.received = [];
    this.html = html;
    this.header = {
      ...recordedHeader, type: 'head', live: true, frame_count: 0,
      parameters: [
        { key: 'collision.collision_stiffness', value: 1e4, unit: 'N/m', applies: 'at once', log: true, min: 1e2, max: 1e7 },
        { key: 'gravity', value: -9.8, unit: 'm/s²', applies: 'at once', log: false, min: -20, max: 20 },
        { key: 'dt', value: 1e-3, unit: 's', applies: 'at reset', log: true, min: 1e-5, max: 1e-2 },
      ],
    };
    this.status = { type: 'status', playing: true, speed: 1, steps_per_second: 1.2e6, pending: [], error: null };
    this.step = 0;
  }

  async open(port = 0) {
    this.server = http.createServer((request, response) => {
      const found = request.url === '/';
      response.writeHead(found ? 200 : 404, { 'content-type': 'text/html; charset=utf-8' });
      response.end(found ? this.html : '');
    });
    this.sockets = new WebSocketServer({ server: this.server, path: '/live' });
    this.sockets.on('connection', (socket) => this.connect(socket));
    await new Promise((done) => this.server.listen(port, '127.0.0.1', done));
    this.port = this.server.address().port;
    this.timer = setInterval(() => this.tick(), 16);
  }

  connect(socket) {
    socket.send(JSON.stringify(this.header));
    socket.send(JSON.stringify(this.status));
    socket.send(frame(this.step * 0.016, this.step, this.header));
    socket.on('message', (data) => this.receive(socket, JSON.parse(data.toString())));
  }

  receive(socket, message) {
    this.received.push(message);
    const { type } = message;
    if (type === 'play' || type === 'pause') this.status.playing = type === 'play';
    if (type === 'step') this.advance();
    if (type === 'speed') this.status.speed = message.value;
    if (type === 'reset') {
      this.step = 0;
      this.status.pending = [];
      socket.send(JSON.stringify(this.header));
      socket.send(frame(0, 0, this.header));
    }
    if (type === 'set') {
      const parameter = this.header.parameters.find(({ key }) => key === message.key);
      parameter.value = message.value;
      if (parameter.applies === 'at reset') this.status.pending = [parameter.key];
    }
    if (type === 'save') socket.send(JSON.stringify({ type: 'saved', toml: 'duration = 3.0\n' }));
    socket.send(JSON.stringify(this.status));
  }

  advance() {
    this.step += 1;
    this.send(frame(this.step * 0.016, this.step, this.header));
  }

  tick() {
    if (this.status.playing) this.advance();
  }

  send(data) {
    for (const socket of this.sockets.clients) socket.send(data);
  }

  // closes all connections and stops listening
  async close() {
    clearInterval(this.timer);
    for (const socket of this.sockets.clients) socket.terminate();
    await new Promise((done) => this.server.close(done));
  }
}
