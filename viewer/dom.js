// Creates DOM elements.

// An element with children. `properties` are properties of the node, except: names with a dash, `role` and `for`
// are attributes, `on` holds event listeners, `css` holds styles.
export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes('-') || key === 'role' || key === 'for') node.setAttribute(key, value);
    else if (key === 'on') for (const [event, handler] of Object.entries(value)) node.addEventListener(event, handler);
    else if (key === 'css') for (const [name, part] of Object.entries(value)) node.style.setProperty(name, part);
    else node[key] = value;
  }
  node.append(...children);
  return node;
}

export const byId = (id) => document.getElementById(id);

// an icon of 20 × 20 units from SVG path data
export function icon(path, filled = false) {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 20 20');
  svg.setAttribute('aria-hidden', 'true');
  const shape = document.createElementNS(space, 'path');
  shape.setAttribute('d', path);
  if (filled) shape.setAttribute('class', 'fill');
  svg.append(shape);
  return svg;
}

export function button(title, label, onClick, ...children) {
  return element('button', { type: 'button', title, 'aria-label': label, on: { click: onClick } }, ...children);
}

// offers a text as a file download
export function download(name, text) {
  const url = URL.createObjectURL(new Blob([text], { type: 'text/plain' }));
  const link = element('a', { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
