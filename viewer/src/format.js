// SPDX-License-Identifier: BSD-3-Clause
// Numbers as people read them, with units; and elements, whose texts are never markup.

export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (name === 'class') made.className = value;
    else if (name === 'style') made.style.cssText = value;
    else if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (name in made && typeof value !== 'string') made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

const grouped = new Intl.NumberFormat('en', {maximumFractionDigits: 0});

export const count = (number) => grouped.format(number);
export const number = (value, digits) => value.toFixed(digits).replace('-', '\u2212');
export const metres = (value, digits = 2) =>
    Number.isFinite(value) ? `${number(value, digits)}\u202fm` : '\u2013';
export const degrees = (radians, digits = 2) =>
    Number.isFinite(radians) ? `${number(radians * 180 / Math.PI, digits)}\u00b0` : '\u2013';
export const percent = (share, digits = 1) => `${number(share * 100, digits)}\u202f%`;
export const seconds = (value) => `${number(value, value < 10 ? 2 : 1)}\u202fs`;
export const squareMetres = (value) => `${grouped.format(value)}\u202fm\u00b2`;
export const elevation = (value) => `${value > 0 ? '+' : ''}${metres(value)}`;

/** Time since the start of the log: 12:34.5 or 1:02:34.5. */
export function clock(value) {
  const tenths = Math.round(value * 10);
  const hours = Math.floor(tenths / 36000);
  const minutes = Math.floor(tenths / 600) % 60;
  const rest = (tenths % 600 / 10).toFixed(1).padStart(4, '0');
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${minutes}:${rest}`;
}

export function distanceText(value) {
  return value >= 1000 ? `${number(value / 1000, 2)}\u202fkm` : `${number(value, 0)}\u202fm`;
}
