// The displayed time. In a live run it follows the latest frame, or stays at an earlier one.

export const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];

export class Player extends EventTarget {
  constructor(recording, live) {
    super();
    this.recording = recording;
    this.live = live;
    this.time = recording.start;
    this.playing = false;
    this.speed = 1;
    this.loop = false;
    // whether the displayed time follows the latest frame of a live run
    this.followsLatest = live;
  }

  changed() {
    this.dispatchEvent(new Event('change'));
  }

  // moves on by clock time (s); returns whether the displayed time has changed
  advance(seconds) {
    if (this.live) {
      if (this.followsLatest && this.time !== this.recording.end) {
        this.time = this.recording.end;
        return true;
      }
      return false;
    }
    if (!this.playing) return false;
    const { start, end } = this.recording;
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
    if (this.time >= this.recording.end) this.time = this.recording.start;
    this.playing = true;
    this.changed();
  }

  pause() {
    this.playing = false;
    this.changed();
  }

  seek(time) {
    const { start, end } = this.recording;
    this.time = Math.min(Math.max(time, start), end);
    this.followsLatest = this.live && this.time >= end;
    this.changed();
  }

  // moves by a number of frames, back if negative
  step(count) {
    this.playing = false;
    const { recording } = this;
    if (!recording.length) return;
    let index = recording.indexAt(this.time + 1e-9);
    // from between two frames, one step back leads to the earlier of them
    if (count < 0 && this.time > recording.frames[index].time + 1e-9) index += 1;
    const target = Math.min(Math.max(index + count, 0), recording.length - 1);
    this.seek(recording.frames[target].time);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.changed();
  }

  // selects a neighbouring speed
  changeSpeed(by) {
    const nearest = SPEEDS.reduce((best, s, i) => (Math.abs(s - this.speed) < Math.abs(SPEEDS[best] - this.speed) ? i : best), 0);
    this.setSpeed(SPEEDS[Math.min(Math.max(nearest + by, 0), SPEEDS.length - 1)]);
  }

  toLatest() {
    this.followsLatest = true;
    this.time = this.recording.end;
    this.changed();
  }
}
