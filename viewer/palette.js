// Colours. The energies have the colour-blind safe palette of Okabe and Ito (2008).

// red, green and blue from 0 to 1
export function rgb(hex) {
  const n = parseInt(hex.slice(1), 16);
  return [(n >> 16) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}

// the columns of the energy ledger, in the order of a frame
export const LEDGER = [
  { name: 'kinetic', label: 'Kinetic', colour: '#0072b2' },
  { name: 'gravitational', label: 'Gravitational', note: 'zero at the origin, as in energy.csv', colour: '#e69f00' },
  { name: 'elastic', label: 'Elastic (contact springs)', colour: '#009e73' },
  { name: 'drag', label: 'Drag', note: 'dissipated by drag', colour: '#56b4e9' },
  { name: 'dashpot', label: 'Dashpot', note: 'dissipated by dashpots', colour: '#cc79a7' },
  { name: 'slip', label: 'Slip', note: 'dissipated by slip', colour: '#d55e00' },
  { name: 'numerical', label: 'Numerical', note: 'lost by the implicit solution of the contact law; it may be negative while bodies slide', colour: '#785ef0' },
  { name: 'spring', label: 'Joint springs', note: 'stored in the springs of joints', colour: '#6ec85a' },
  { name: 'joint_friction', label: 'Joint friction', note: 'dissipated by friction, dampers and limits of joints', colour: '#966e50' },
];

// colours of bodies: lighter variants of the palette
export const BODY_COLOURS = ['#3f8fc9', '#e8a33d', '#35a383', '#c983ac', '#dd7a45', '#7ab8dd', '#b7a93a', '#8d86c9'].map(rgb);

// the colour of fixed and prescribed bodies
export const PRESCRIBED_COLOUR = rgb('#969aa0');

// the colours of joints, of the arrows of motors, of the selected joint, and of loads
export const JOINT_COLOURS = {
  joint: { light: '#3c434c', dark: '#dfe4ea' },
  motor: { light: '#c2342b', dark: '#ff8a7a' },
  selected: { light: '#d6006e', dark: '#ff5fae' },
  load: { light: '#6d3fc0', dark: '#b794ff' },
};

export const THEMES = {
  light: {
    top: rgb('#f7f6f2'),
    bottom: rgb('#e6e5df'),
    floor: rgb('#f1f0eb'),
    grid: rgb('#8b8f96'),
    frame: rgb('#c8453b'),
    ink: rgb('#20252b'),
    path: rgb('#5b6470'),
    sky: [0.62, 0.64, 0.68],
    ground: [0.40, 0.37, 0.34],
    sun: [0.62, 0.6, 0.55],
    shadow: 0.34,
    edge: [0.05, 0.07, 0.1, 0.42],
    lift: 0,
  },
  dark: {
    top: rgb('#171a1f'),
    bottom: rgb('#0f1114'),
    floor: rgb('#20242a'),
    grid: rgb('#8e98a5'),
    frame: rgb('#e8695e'),
    ink: rgb('#eef1f4'),
    path: rgb('#aab3bf'),
    sky: [0.42, 0.45, 0.52],
    ground: [0.2, 0.19, 0.2],
    sun: [0.7, 0.68, 0.64],
    shadow: 0.6,
    edge: [0.02, 0.03, 0.05, 0.55],
    lift: 0.06,
  },
};
