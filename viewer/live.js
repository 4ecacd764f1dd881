// The connection to a running simulation: opened again, more and more patiently, when it breaks.

const FIRST_WAIT = 500;
const LONGEST_WAIT = 10000;

export class Live {
  // `hears`: head(object), frame(ArrayBuffer), status(object), saved(toml), refused(why), link(state, seconds)
  constructor(url, hears) {
    this.url = url;
    this.hears = hears;
    this.wait = FIRST_WAIT;
    this.status = { playing: false, speed: 1, steps_per_second: 0, pending: [], error: null };
    this.connect();
  }

  connect() {
    clearTimeout(this.timer);
    this.hears.link('connecting', 0);
    const socket = new WebSocket(this.url);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.addEventListener('open', () => {
      this.wait = FIRST_WAIT;
      this.hears.link('open', 0);
    });
    socket.addEventListener('message', ({ data }) => (typeof data === 'string' ? this.text(data) : this.hears.frame(data)));
    socket.addEventListener('close', () => {
      if (this.socket !== socket) return;
      this.hears.link('closed', this.wait / 1000);
      this.timer = setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
    });
  }

  text(data) {
    let message;
    try {
      message = JSON.parse(data);
    } catch {
      this.hears.refused('the server said something that is no JSON');
      return;
    }
    if (message.type === 'head') this.hears.head(message);
    else if (message.type === 'status') {
      this.status = { ...this.status, ...message };
      this.hears.status(this.status);
    } else if (message.type === 'saved') this.hears.saved(message.toml);
    else if (message.type === 'refused') this.hears.refused(message.why);
  }

  // whether it could be sent
  send(message) {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
}
