// SPDX-License-Identifier: BSD-3-Clause
// One node or closure in words, for the tooltip and the card.
import {editLine} from './edit_line.js';
import {clock, degrees, element, metres, percent, number} from './format.js';
import {closureStates} from './states.js';

const stampText = (model, stamp) => `${clock(stamp - model.start)} (${stamp}\u202fs)`;

export function key(kind, colour) {
  return element('span', {class: `key ${kind}`, style: `${kind.startsWith('line') ? 'border-color' : 'background'}: var(${colour})`});
}

function list(rows) {
  return element('dl', {}, rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
}

export function closureDetails(model, attempt) {
  const rows = [
    ['Newer scan', stampText(model, attempt.tA)],
    ['Older scan', stampText(model, attempt.tB)],
    ['Floor', model.floors[attempt.floor].label],
    ['Score', percent(attempt.score)],
    ['Votes', String(attempt.votes)],
    ['Mahalanobis', number(attempt.mahalanobis, 2)],
  ];
  if (attempt.agreement > 0) rows.push(['Agreement', percent(attempt.agreement)]);
  if (Number.isFinite(attempt.error)) {
    rows.push(['Off the map by', `${metres(attempt.error, 3)}, ${degrees(attempt.angleError)}`]);
  }
  if (attempt.reason) rows.push(['Reason', attempt.reason]);
  const look = closureStates[attempt.state];
  return [element('strong', {}, key('line', look.colour), `Closure: ${look.name.toLowerCase()}`), list(rows)];
}

export function nodeDetails(model, id) {
  const {nodes, attempts} = model;
  const tried = attempts.filter(({a, b}) => a === id || b === id);
  const validated = tried.filter(({state}) => state === 'validated').length;
  const [x, y, theta] = nodes.after.subarray(3 * id, 3 * id + 3);
  const moved = Math.hypot(x - nodes.before[3 * id], y - nodes.before[3 * id + 1]);
  const [x0, y0] = model.origin;
  const rows = [
    ['Time', stampText(model, nodes.stamp[id])],
    ['Floor', model.floors[nodes.floor[id]].label],
    ['Pose', `${metres(x + x0)}, ${metres(y + y0)}, ${degrees(theta, 1)}`],
    ['Moved by', metres(moved)],
  ];
  if (nodes.hasScan[id]) rows.push(['Closures', `${validated} of ${tried.length} tried`]);
  const kind = nodes.hasScan[id] ? 'scan' : 'odometry only';
  return [
    element('strong', {}, key(nodes.hasScan[id] ? 'dot' : 'dot small', nodes.hasScan[id] ? '--node' : '--odometry'),
            `Node ${id}: ${kind}`),
    list(rows),
  ];
}

export const details = (model, item) =>
    item.attempt ? closureDetails(model, item.attempt) : nodeDetails(model, item.node);

export function editElement(attempt) {
  const line = editLine(attempt);
  const copy = element('button', {
    type: 'button', onclick: async () => {
      try {
        await navigator.clipboard.writeText(line);
        copy.textContent = 'Copied';
      } catch {  // not allowed from disk in every browser
        getSelection().selectAllChildren(code);
        copy.textContent = 'Marked';
      }
      setTimeout(() => { copy.textContent = 'Copy'; }, 1500);
    },
  }, 'Copy');
  const code = element('code', {}, line);
  return [
    element('p', {class: 'below', style: 'margin: 0 0 3px'},
            attempt.state === 'validated' ? 'To take it out, in edits.yaml:' : 'To put it in, in edits.yaml:'),
    element('div', {class: 'edit'}, code, copy),
  ];
}
