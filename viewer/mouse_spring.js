// Dragging a body of a live run with the mouse: the server pulls a particle with a spring and dashpot towards the
// pointer.

import { intersectPlane, nearestParticle, particlePosition, pickBody } from './picking.js';

export class MouseSpring {
  constructor(send) {
    this.send = send;
    // whether dragging works without holding Shift
    this.dragMode = false;
    this.attached = null;
  }

  // attaches the spring to the body under the ray; returns whether there is one
  attach(ray, back, header, snapshot) {
    const hit = snapshot.frame ? pickBody(ray, header, snapshot) : null;
    if (!hit) return false;
    const { particle, position } = nearestParticle(header, snapshot, hit.body, hit.point);
    // the target moves in the plane that is parallel to the image plane now
    this.attached = { body: hit.body, particle, target: position, planePoint: position, normal: back };
    this.send({ type: 'grab', body: hit.body, particle, target: position });
    return true;
  }

  move(ray) {
    if (!this.attached) return;
    this.attached.target = intersectPlane(ray, this.attached.planePoint, this.attached.normal);
    // at most one message per displayed frame
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.attached) this.send({ type: 'move', target: this.attached.target });
    });
  }

  release() {
    if (!this.attached) return;
    this.attached = null;
    this.send({ type: 'release' });
  }

  // the two ends of the spring, for drawing; null if it is not attached
  ends(header, snapshot) {
    if (!this.attached || !snapshot.frame) return null;
    return [particlePosition(header, snapshot, this.attached.body, this.attached.particle), this.attached.target];
  }
}
