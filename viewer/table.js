// A table whose rows can be selected with mouse and keys. Only the visible rows exist as elements.

import { element } from './dom.js';

const ROW = 30; // row height in CSS pixels
// with more rows the table scrolls
const MAX_VISIBLE = 8;

// A subclass has the methods name(index), the children of the row header, and texts(index, snapshot), the other cells.
export class Table {
  // `names`: of the rows; `columns`: [title, unit] pairs; `key`: prefix of the ids of rows; `label`: what the rows are
  constructor(names, columns, key, label, select) {
    this.names = names;
    this.columns = columns;
    this.key = key;
    this.select = select;
    this.selected = null;
    this.visibleRows = new Map();
    this.rows = element('div', { className: 'rows', css: { height: `${ROW * names.length}px` } });
    this.scroll = element('div', {
      className: 'scroll', tabIndex: 0, role: 'grid', 'aria-label': `${label}. Up and down arrow keys select a row, Escape clears the selection.`,
      'aria-rowcount': String(names.length + 1),
      on: { scroll: () => this.update(this.snapshot), keydown: (event) => this.onKey(event) },
    }, this.columnHeaders(), this.rows);
    this.scroll.style.setProperty('--rows', String(Math.min(names.length, MAX_VISIBLE)));
  }

  columnHeaders() {
    const cells = this.columns.map(([text, unit]) => element('span', { role: 'columnheader' }, text, element('small', {}, unit)));
    return element('div', { className: 'row head', role: 'row' }, ...cells);
  }

  onKey(event) {
    const { length: count } = this.names;
    const page = Math.max(Math.floor(this.scroll.clientHeight / ROW) - 2, 1);
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page }[event.key];
    if (by === undefined && event.key !== 'Home' && event.key !== 'End') return;
    event.preventDefault();
    event.stopPropagation();
    const from = this.selected ?? (by > 0 ? -1 : count);
    const to = event.key === 'Home' ? 0 : event.key === 'End' ? count - 1 : from + by;
    this.select(Math.min(Math.max(to, 0), count - 1));
  }

  setSelected(index) {
    this.selected = index;
    if (index !== null) {
      const { scrollTop, clientHeight } = this.scroll;
      const y = ROW * index;
      if (y < scrollTop) this.scroll.scrollTop = y;
      else if (y + 2 * ROW > scrollTop + clientHeight) this.scroll.scrollTop = y + 2 * ROW - clientHeight;
      this.scroll.setAttribute('aria-activedescendant', `${this.key}-${index}`);
    } else {
      this.scroll.removeAttribute('aria-activedescendant');
    }
    this.update(this.snapshot);
  }

  row(index) {
    const cells = this.columns.slice(1).map(() => element('span', { role: 'gridcell' }));
    const name = element('span', { role: 'rowheader', title: this.names[index] }, ...this.name(index));
    const node = element('div', {
      className: 'row', role: 'row', id: `${this.key}-${index}`, 'aria-rowindex': String(index + 2), css: { top: `${ROW * index}px` },
      on: { click: () => this.select(this.selected === index ? null : index) },
    }, name, ...cells);
    return { node, cells };
  }

  update(snapshot) {
    this.snapshot = snapshot;
    const { scrollTop, clientHeight } = this.scroll;
    if (!snapshot?.frame || !clientHeight) return;
    const first = Math.max(Math.floor(scrollTop / ROW) - 1, 0);
    const last = Math.min(first + Math.ceil(clientHeight / ROW) + 2, this.names.length);
    for (const [index, { node }] of this.visibleRows) {
      if (index >= first && index < last) continue;
      node.remove();
      this.visibleRows.delete(index);
    }
    for (let index = first; index < last; index++) {
      let row = this.visibleRows.get(index);
      if (!row) {
        row = this.row(index);
        this.visibleRows.set(index, row);
        this.rows.append(row.node);
      }
      this.write(row, index, snapshot);
    }
  }

  write({ node, cells }, index, snapshot) {
    this.texts(index, snapshot).forEach((text, i) => {
      if (cells[i].textContent !== text) cells[i].textContent = text;
    });
    const isSelected = String(index === this.selected);
    if (node.getAttribute('aria-selected') !== isSelected) node.setAttribute('aria-selected', isSelected);
  }
}
