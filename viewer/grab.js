// Dragging a body of a live run: a thread from the particle that was taken to the pointer.

import { nearestParticle, onPlane, particlePlace, pickBody } from './pick.js';

export class Grab {
  constructor(send) {
    this.send = send;
    this.mode = false;
    this.held = null;
  }

  // takes the body under the ray; whether there was one
  begin(ray, back, head, moment) {
    const hit = moment.frame ? pickBody(ray, head, moment) : null;
    if (!hit) return false;
    const { particle, place } = nearestParticle(head, moment, hit.body, hit.point);
    // the plane stays as it is, however the view moves on
    this.held = { body: hit.body, particle, target: place, plane: place, back };
    this.send({ type: 'grab', body: hit.body, particle, target: place });
    return true;
  }

  move(ray) {
    if (!this.held) return;
    this.held.target = onPlane(ray, this.held.plane, this.held.back);
    // as often as the screen shows it, not as often as the mouse speaks
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.held) this.send({ type: 'move', target: this.held.target });
    });
  }

  end() {
    if (!this.held) return;
    this.held = null;
    this.send({ type: 'release' });
  }

  // both ends of the thread
  thread(head, moment) {
    if (!this.held || !moment.frame) return null;
    return [particlePlace(head, moment, this.held.body, this.held.particle), this.held.target];
  }
}
