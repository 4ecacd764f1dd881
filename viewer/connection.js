// The WebSocket connection to the server; when it breaks, it reconnects after increasing delays.

const MIN_DELAY = 500; // ms
const MAX_DELAY = 10000; // ms

export class Connection {
  // `handlers`: header(object), frame(ArrayBuffer), status(object), saved(toml), refused(reason), state(state, seconds)
  constructor(url, handlers) {
    this.url = url;
    this.handlers = handlers;
    this.delay = MIN_DELAY;
    this.status = { playing: false, speed: 1, steps_per_second: 0, pending: [], error: null };
    this.connect();
  }

  connect() {
    clearTimeout(this.timer);
    this.handlers.state('connecting', 0);
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.addEventListener('open', () => {
      this.delay = MIN_DELAY;
      this.handlers.state('open', 0);
    });
    socket.addEventListener('message', ({ data }) => (typeof data === 'string' ? this.receive(data) : this.handlers.frame(data)));
    socket.addEventListener('close', () => {
      if (this.socket !== socket) return;
      this.handlers.state('closed', this.delay / 1000);
      this.timer = setTimeout(() => this.connect(), this.delay);
      this.delay = Math.min(2 * this.delay, MAX_DELAY);
    });
  }

  receive(data) {
    let message;
    try {
      message = JSON.parse(data);
    } catch {
      this.handlers.refused('the server sent a message that is not JSON');
      return;
    }
    if (message.type === 'head') this.handlers.header(message);
    else if (message.type === 'status') {
      this.status = { ...this.status, ...message };
      this.handlers.status(this.status);
    } else if (message.type === 'saved') this.handlers.saved(message.toml);
    else if (message.type === 'refused') this.handlers.refused(message.why);
  }

  // returns whether the message could be sent
  send(message) {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
}
