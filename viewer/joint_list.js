// The list of joints in the panel, and the selected joint: its values now and one of them over time.

import { element } from './dom.js';
import { number, quantity, vector } from './format.js';
import { HAS_LENGTH, coordinateUnit, hasLetGo } from './joints.js';
import { length } from './math.js';
import { jointOf } from './recording.js';
import { Table } from './table.js';
import { BOTTOM, LEFT, RIGHT, TOP, TimePlot } from './time_plot.js';

const degrees = (angle) => `${((angle * 180) / Math.PI).toFixed(1).replace('-', '−')}°`;

// what the plot can show of a joint
const COURSES = {
  force: { label: () => '|F|', unit: () => 'N', value: ({ force }) => length(force) },
  torque: { label: () => '|τ|', unit: () => 'N·m', value: ({ torque }) => length(torque) },
  coordinate: { label: coordinateName, unit: coordinateUnit, value: ({ coordinate }) => coordinate },
  rate: { label: () => 'Rate', unit: (joint) => `${coordinateUnit(joint)}/s`, value: ({ rate }) => rate },
};

function coordinateName(joint) {
  if (coordinateUnit(joint) === 'rad') return 'Angle';
  return HAS_LENGTH.has(joint.kind) ? 'Length' : 'Displacement';
}

// what a joint did in the step before a frame, without torques that are only rounding
function stateOf(header, frame, index) {
  const state = jointOf(frame, index);
  const [body] = header.joints[index].bodies.filter((other) => other !== null);
  const size = header.shapes[header.bodies[body].shape].radius;
  return length(state.torque) > 1e-9 * size * length(state.force) ? state : { ...state, torque: [0, 0, 0] };
}

class JointTable extends Table {
  constructor(header, select) {
    super(header.joints.map(({ name }) => name), [['Joint', ''], ['Kind', ''], ['|F|', 'N'], ['|τ|', 'N·m']], 'joint', 'Joints', select);
    this.header = header;
  }

  name(joint) {
    return [this.names[joint]];
  }

  texts(index, snapshot) {
    const joint = this.header.joints[index];
    const { force, torque } = stateOf(this.header, snapshot.frame, index);
    const isOff = hasLetGo(joint, snapshot.time);
    return [joint.kind, isOff ? '–' : number(length(force)), isOff ? '–' : number(length(torque))];
  }
}

// one quantity of a joint over time
class JointPlot extends TimePlot {
  constructor(header, player) {
    super(player, 'A quantity of the selected joint over time');
    this.header = header;
    this.joint = null;
    this.course = 'force';
  }

  value(frame) {
    return COURSES[this.course].value(stateOf(this.header, frame, this.joint));
  }

  get unit() {
    return COURSES[this.course].unit(this.header.joints[this.joint]);
  }

  paint() {
    const pen = this.startPainting();
    const points = this.points();
    let [low, top] = points.reduce(([a, b], [, value]) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    // magnitudes are seen from zero on
    if (this.course === 'force' || this.course === 'torque') low = 0;
    const middle = Math.max(Math.abs(low), Math.abs(top));
    if (!(top - low > 1e-9 * middle)) [low, top] = low === 0 && top === 0 ? [0, 1] : [low - 0.1 * middle, top + 0.1 * middle];
    const margin = 0.06 * (top - low);
    const [least, most] = [low === 0 ? 0 : low - margin, top + margin];
    const y = (value) => this.height - BOTTOM - ((value - least) / (most - least)) * (this.height - TOP - BOTTOM);
    const style = getComputedStyle(this.area);
    this.axes(pen, [least, most], this.unit, y, style);
    pen.beginPath();
    pen.rect(LEFT, 0, this.width - LEFT - RIGHT, this.height);
    pen.clip();
    pen.strokeStyle = style.getPropertyValue('--joint');
    pen.lineWidth = 1.4;
    pen.lineJoin = 'round';
    pen.beginPath();
    points.forEach(([time, value]) => pen.lineTo(this.xOf(time), y(value)));
    pen.stroke();
  }

  // Times and values. Of a long recording, the least and the largest value of each half pixel: a short force stays visible.
  points() {
    const { frames } = this.player.recording;
    const step = Math.max(1, Math.floor(frames.length / this.width));
    const { until } = this.header.joints[this.joint];
    const list = [];
    for (let from = 0; from < frames.length; from += step) {
      const part = frames.slice(from, from + step).filter(({ time }) => until === null || time < until).map((frame) => [frame.time, this.value(frame)]);
      const finite = part.filter(([, value]) => Number.isFinite(value));
      if (!finite.length) continue;
      const least = finite.reduce((a, b) => (b[1] < a[1] ? b : a));
      const most = finite.reduce((a, b) => (b[1] > a[1] ? b : a));
      list.push(...(least === most ? [least] : least[0] < most[0] ? [least, most] : [most, least]));
    }
    return list;
  }

  showTip(x) {
    const frame = this.joint === null ? null : this.frameUnder(x);
    if (!frame) return;
    this.tip.replaceChildren(element('b', {}, `${Number(frame.time.toPrecision(6))} s`), element('div', {}, quantity(this.value(frame), this.unit, 4)));
  }
}

export class JointList {
  constructor(header, player, select) {
    this.header = header;
    this.table = new JointTable(header, select);
    this.plot = new JointPlot(header, player);
    this.selected = null;
    this.detail = element('div', { id: 'joint-detail', hidden: true });
    this.name = element('b', {});
    this.between = element('span', { className: 'muted' });
    this.cells = [];
    this.values = element('dl', {});
    this.choice = element('select', { id: 'joint-course', 'aria-label': 'Quantity in the plot', on: { change: () => this.setCourse(this.choice.value) } });
    this.detail.append(element('div', { className: 'top' }, this.name, this.between), this.values, element('label', { className: 'choice' }, element('span', {}, 'Plot'), this.choice), this.plot.area);
  }

  setCourse(course) {
    this.plot.course = course;
    this.updatePlot(this.themeName);
  }

  setSelected(index) {
    this.selected = index;
    this.table.setSelected(index);
    this.detail.hidden = index === null;
    if (index === null) return;
    const joint = this.header.joints[index];
    const names = joint.bodies.map((body) => (body === null ? 'world' : this.header.bodies[body].name));
    this.name.textContent = joint.name;
    this.name.title = joint.name;
    const until = joint.until === null ? '' : `, until ${quantity(joint.until, 's')}`;
    this.between.textContent = `${joint.kind}, ${names.join(' – ')}${until}`;
    this.between.title = this.between.textContent;
    const unit = coordinateUnit(joint);
    const rows = [['|F|', 'N'], ['F', 'N'], ['|τ|', 'N·m'], ['τ', 'N·m'], ...(unit ? [[coordinateName(joint), unit], ['Rate', `${unit}/s`]] : [])];
    this.cells = rows.map(() => element('dd', {}));
    this.values.replaceChildren(...rows.flatMap(([row, of], i) => [element('dt', {}, row, element('small', {}, of)), this.cells[i]]));
    const courses = Object.keys(COURSES).filter((key) => unit || key === 'force' || key === 'torque');
    if (!courses.includes(this.plot.course)) this.plot.course = 'force';
    this.choice.replaceChildren(...courses.map((key) => new Option(`${COURSES[key].label(joint)} (${COURSES[key].unit(joint)})`, key, false, key === this.plot.course)));
    this.plot.joint = index;
    this.detail.scrollIntoView({ block: 'nearest' });
  }

  // updates the numbers
  tick(snapshot) {
    this.table.update(snapshot);
    if (this.selected === null || !snapshot.frame) return;
    const { force, torque, coordinate, rate } = stateOf(this.header, snapshot.frame, this.selected);
    const isAngle = coordinateUnit(this.header.joints[this.selected]) === 'rad';
    const texts = [number(length(force), 4), vector(force), number(length(torque), 4), vector(torque)];
    texts.push(isAngle ? `${number(coordinate, 4)}  (${degrees(coordinate)})` : number(coordinate, 4), number(rate, 4));
    this.cells.forEach((cell, i) => {
      if (cell.textContent !== texts[i]) cell.textContent = texts[i];
    });
  }

  // redraws the plot if need be, and moves its cursor
  updatePlot(themeName) {
    this.themeName = themeName;
    if (this.selected !== null) this.plot.update(themeName, `${this.selected} ${this.plot.course}`);
  }
}
