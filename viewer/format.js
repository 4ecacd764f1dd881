// Numbers with their units as text.

// `digits` significant digits; with a power of ten below 0.0001 and from a million on
export function number(x, digits = 3) {
  if (x === null || x === undefined || Number.isNaN(x)) return '–';
  if (!Number.isFinite(x)) return x > 0 ? '∞' : '−∞';
  const size = Math.abs(x);
  let text;
  if (size === 0) text = '0';
  else if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = x.toExponential(Math.max(digits - 1, 0)).split('e');
    text = `${mantissa}·10${superscript(Number(exponent))}`;
  } else {
    const places = clampPlaces(digits - 1 - Math.floor(Math.log10(size)));
    text = x.toFixed(places);
    if (size >= 10000) text = text.replace(/\B(?=(\d{3})+(?!\d))/g, '\u2009');
  }
  return text.replace('-', '−');
}

const clampPlaces = (n) => Math.min(Math.max(n, 0), 8);

function superscript(n) {
  const digits = '⁰¹²³⁴⁵⁶⁷⁸⁹';
  return (n < 0 ? '⁻' : '') + [...String(Math.abs(n))].map((d) => digits[Number(d)]).join('');
}

export const quantity = (x, unit, digits = 3) => `${number(x, digits)}\u202f${unit}`;

// a time (s) with enough decimals to distinguish frames `interval` apart
export function time(t, interval) {
  const places = Math.min(Math.max(Math.ceil(-Math.log10(Math.max(interval, 1e-9)) - 1e-9), 1), 9);
  return t.toFixed(places).replace('-', '−');
}

// the round number closest to x: 1, 2 or 5 times a power of ten
export function round125(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  const rest = x / power;
  return (rest < 1.5 ? 1 : rest < 3.5 ? 2 : rest < 7.5 ? 5 : 10) * power;
}

// the components of a vector, all with the decimals of the largest
export function vector(v) {
  const largest = Math.max(...v.map(Math.abs));
  if (!(largest > 0) || largest >= 1e5 || largest < 1e-3) return v.map((x) => (Math.abs(x) < 1e-6 * largest ? '0' : number(x))).join('  ');
  const places = clampPlaces(2 - Math.floor(Math.log10(largest)));
  return v.map((x) => x.toFixed(places).replace(/^-(0\.?0*)$/, '$1').replace('-', '−')).join('  ');
}

export const count = (n) => String(n).replace(/\B(?=(\d{3})+(?!\d))/g, '\u2009');
