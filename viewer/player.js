// Time as it is shown: playing, paused, scrubbed; of a live run, at its newest frame or back in it.

export const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];

export class Player extends EventTarget {
  constructor(film, live) {
    super();
    this.film = film;
    this.live = live;
    this.time = film.start;
    this.playing = false;
    this.speed = 1;
    this.loop = false;
    // a live run: whether the newest frame is shown
    this.follow = live;
  }

  changed() {
    this.dispatchEvent(new Event('change'));
  }

  // so many seconds later; whether anything moved
  advance(seconds) {
    if (this.live) {
      if (this.follow && this.time !== this.film.end) {
        this.time = this.film.end;
        return true;
      }
      return false;
    }
    if (!this.playing) return false;
    const { start, end } = this.film;
    this.time += seconds * this.speed;
    if (this.time >= end) {
      if (this.loop && end > start) {
        this.time = start + ((this.time - start) % (end - start));
      } else {
        this.time = end;
        this.playing = false;
        this.changed();
      }
    }
    return true;
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.time >= this.film.end) this.time = this.film.start;
    this.playing = true;
    this.changed();
  }

  pause() {
    this.playing = false;
    this.changed();
  }

  seek(time) {
    const { start, end } = this.film;
    this.time = Math.min(Math.max(time, start), end);
    this.follow = this.live && this.time >= end;
    this.changed();
  }

  // so many frames on or back
  step(count) {
    this.playing = false;
    const { film } = this;
    if (!film.length) return;
    let index = film.indexAt(this.time + 1e-9);
    // between two frames, back is the one before
    if (count < 0 && this.time > film.frames[index].time + 1e-9) index += 1;
    const to = Math.min(Math.max(index + count, 0), film.length - 1);
    this.seek(film.frames[to].time);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.changed();
  }

  faster(by) {
    const nearest = SPEEDS.reduce((best, s, i) => (Math.abs(s - this.speed) < Math.abs(SPEEDS[best] - this.speed) ? i : best), 0);
    this.setSpeed(SPEEDS[Math.min(Math.max(nearest + by, 0), SPEEDS.length - 1)]);
  }

  toNow() {
    this.follow = true;
    this.time = this.film.end;
    this.changed();
  }
}
