// SPDX-License-Identifier: BSD-3-Clause
// The pages beside the map.
import {key} from './details.js';
import {clock, count, distanceText, element, elevation, metres, number, seconds, squareMetres, percent} from './format.js';
import {plots} from './plots.js';
import {closureStates, stateName} from './states.js';

function part(title, ...children) {
  return element('section', {class: 'part'}, element('h2', {}, title), ...children);
}

function segmented(name, label, options, chosen, onchange) {
  return element('div', {class: 'segmented', role: 'radiogroup', 'aria-label': label}, options.map(([value, text]) =>
      element('label', {}, element('input', {
        type: 'radio', name, value, checked: value === chosen, onchange: () => onchange(value),
      }), text)));
}

function slider(id, label, {min = 0, max, step, value, text, onchange}) {
  const output = element('output', {for: id}, text(value));
  return element('div', {class: 'slider'}, element('label', {for: id}, label), output, element('input', {
    id, type: 'range', min: String(min), max: String(max), step: String(step), value: String(value),
    'aria-valuetext': text(value),
    oninput: (event) => {
      const now = Number(event.target.value);
      output.textContent = text(now);
      event.target.setAttribute('aria-valuetext', text(now));
      onchange(now);
    },
  }));
}

function toggle({id, mark, label, note, more, checked, onchange, none}) {
  return element('li', {}, element('label', {class: none ? 'none' : undefined},
      element('input', {type: 'checkbox', id, checked, onchange: (event) => onchange(event.target.checked)}),
      mark, element('span', {}, label),
      element('span', {class: 'number quiet'}, note ?? ''), element('span', {class: 'number'}, more ?? '')));
}

// From what lies about to a hand below the lintel of a door: what is in the way.
const usualBand = [0.2, 1.9];

/** The heights between which points of space are shown. */
function bandPart({space}, scene) {
  if (!space) return null;
  const step = 0.05;
  const min = Math.floor(space.lowest / step) * step;
  const max = Math.ceil(space.highest / step) * step;
  const within = (height) => Math.min(max, Math.max(min, height));
  const band = usualBand.map(within);
  // Neither end passes the other: it takes it along.
  const put = (end, other, inOrder) => (height) => {
    band[end] = height;
    scene?.setBand(...band);
    const input = inOrder(height, band[other]) ? null : page.querySelector(`#band-${other ? 'high' : 'low'}`);
    if (!input) return;
    input.value = String(height);
    input.dispatchEvent(new Event('input'));
  };
  const end = (id, label, index, onchange) => slider(id, label, {
    min, max, step, value: band[index], text: (height) => metres(height, 2), onchange,
  });
  const page = part('Points by height', element('div', {role: 'group', 'aria-label': 'Heights of the points shown, above their floors'},
      end('band-low', 'From, above the floor', 0, put(0, 1, (low, high) => low <= high)),
      end('band-high', 'To, above the floor', 1, put(1, 0, (high, low) => low <= high))),
      element('p', {class: 'below'}, `What the 3D lidar saw, above each floor: one point per ${metres(space.spacing, 2)}.`));
  scene?.setBand(...band);
  return page;
}

export function mapPage(page, model, scene, {blendTo, separation}) {
  const {floors, nodes, edges, attempts} = model;
  const moved = Array.from({length: nodes.count}, (_, i) => Math.hypot(
      nodes.after[3 * i] - nodes.before[3 * i], nodes.after[3 * i + 1] - nodes.before[3 * i + 1]));
  const largest = moved.reduce((a, b) => Math.max(a, b), 0);
  const mean = moved.length ? moved.reduce((a, b) => a + b, 0) / moved.length : 0;

  const downwards = [...floors].sort((a, b) => b.elevation - a.elevation || a.index - b.index);
  const floorList = element('ul', {class: 'toggles', id: 'floors'}, downwards.map((floor) => toggle({
    id: `floor-${floor.index}`, mark: element('span', {class: 'key area', style: `background: ${floor.colour}`}),
    label: floor.label, note: `${elevation(floor.elevation)}${floor.measured ? '' : ' (assumed)'}`,
    more: squareMetres(floor.area), checked: true, onchange: (shown) => scene?.setFloor(floor.index, shown),
  })));
  const all = (shown) => () => {
    for (const box of floorList.querySelectorAll('input')) {
      if (box.checked !== shown) box.click();
    }
  };

  const numberOf = (state) => attempts.filter((attempt) => attempt.state === state).length;
  const kindCount = (kind) => edges.filter((edge) => edge.kind === kind).length;
  const scanNodes = nodes.hasScan.reduce((sum, has) => sum + has, 0);
  const layer = (name, label, mark, amount, checked = true) => {
    if (scene && !checked) scene.setLayer(name, false);
    return toggle({id: `layer-${name}`, mark, label, more: amount === undefined ? '' : count(amount), checked,
                   none: amount === 0, onchange: (shown) => scene?.setLayer(name, shown)});
  };
  const byHand = kindCount('closure') - numberOf('validated');
  const floorsPart = part('Floors', floorList, floors.length > 1 ? slider('separation', 'Pull floors apart', {
    max: Math.max(10, Math.round((scene?.extent ?? 50) / 2)), step: 0.5, value: separation,
    text: (value) => `+${metres(value, 1)} per storey`, onchange: (value) => scene?.setSeparation(value),
  }) : null, slider('wall-height', 'Wall height, as drawn', {
    max: 3, step: 0.1, value: scene?.wallHeight ?? 0, text: (value) => metres(value, 1),
    onchange: (value) => scene?.setWallHeight(value),
  }));
  if (floors.length > 1) {
    floorsPart.firstChild.append(element('span', {class: 'tools'},
        element('button', {type: 'button', class: 'link', onclick: all(true)}, 'all'),
        element('button', {type: 'button', class: 'link', onclick: all(false)}, 'none')));
  }
  page.append(
      part('Poses',
           segmented('blend', 'Poses shown', [['before', 'Dead reckoning'], ['after', 'Optimised']], 'after', blendTo),
           element('p', {class: 'below'}, `Optimisation moved the nodes by ${metres(mean)} on average, ${metres(largest)} at most.`)),
      floorsPart,
      bandPart(model, scene) ?? '',
      part('Shown', element('ul', {class: 'toggles'},
          layer('walls', 'Walls', key('area', '--quiet')),
          layer('free', 'Free space', key('area', '--line')),
          model.space ? layer('space', 'Points of the 3D lidar', key('area', '--space-high'), model.space.count) : null,
          layer('trajectory', 'Trajectory', key('line', '--trajectory')),
          layer('scan_nodes', 'Scan nodes', key('dot', '--node'), scanNodes),
          layer('odometry_nodes', 'Odometry-only nodes', key('dot small', '--odometry'), nodes.count - scanNodes),
          layer('odometry', 'Odometry edges', key('line', '--odometry'), kindCount('odometry'), false),
          layer('floor_change', 'Floor changes', key('line dashed', '--floor-change'), kindCount('floor_change')),
          model.route ? layer('route', `Way of ${metres(model.route.length_m, 1)}`, key('line', '--route')) : null,
          model.doubts.length ? layer('doubts', 'Doubts', key('line', '--audited'), model.doubts.length) : null)),
      part('Closures', element('ul', {class: 'toggles'},
          Object.entries(closureStates).map(([state, look]) =>
              layer(state, look.name, key('line', look.colour), numberOf(state), state !== 'rejected_score')),
          byHand > 0 ? layer('by_hand', 'Added by hand', key('line', '--by-hand'), byHand) : null)),
      part('Look from', element('div', {class: 'row'},
          [['oblique', 'Oblique'], ['top', 'Above'], ['side', 'Side']].map(([from, text]) =>
              element('button', {type: 'button', id: `look-${from}`, onclick: () => scene?.look(from)}, text))),
          element('p', {class: 'below'}, 'Drag turns, right drag moves, wheel zooms; a click keeps what it is on. ',
              'Keys, on the map: ', element('kbd', {}, 'arrows'), ' turn, ', element('kbd', {}, 'shift'), ' + arrows move, ',
              element('kbd', {}, '+'), ' ', element('kbd', {}, '\u2212'), ' zoom, ', element('kbd', {}, '0'), ' shows all.')));
}

const orders = {
  time: ['Time', (a, b) => a.tA - b.tA],
  error: ['Error, largest first', (a, b) => (b.error || 0) - (a.error || 0)],
  score: ['Score, lowest first', (a, b) => a.score - b.score],
  votes: ['Votes, fewest first', (a, b) => a.votes - b.votes],
};

export function closuresPage(page, model, onpick) {
  const {attempts, floors} = model;
  const present = Object.keys(closureStates).filter((state) => attempts.some((attempt) => attempt.state === state));
  const chosen = {state: present.includes('validated') ? 'validated' : '', floor: '', order: 'time'};
  const list = element('ol', {class: 'closures'});
  const status = element('p', {class: 'below', role: 'status'});
  const more = element('button', {type: 'button', style: 'margin-top: 10px', onclick: () => show(100)}, 'Show 100 more');
  let found = [];
  let shown = 0;
  function row(attempt) {
    const facts = [`score ${percent(attempt.score)}`, `${attempt.votes} ${attempt.votes === 1 ? 'vote' : 'votes'}`];
    if (Number.isFinite(attempt.error)) facts.push(`error ${metres(attempt.error, 3)}`);
    if (attempt.reason) facts.push(attempt.reason);
    const button = element('button', {
      type: 'button', onclick: () => {
        list.querySelector('[aria-current]')?.removeAttribute('aria-current');
        button.setAttribute('aria-current', 'true');
        onpick(attempt);
      },
    }, key('line', closureStates[attempt.state].colour),
       element('span', {class: 'mono'}, `${clock(attempt.tA - model.start)} \u2194 ${clock(attempt.tB - model.start)}`),
       element('span', {class: 'quiet'}, `${stateName(attempt.state)}, floor ${floors[attempt.floor].label}`),
       element('span', {class: 'what'}, facts.join(' \u00b7 ')));
    return element('li', {}, button);
  }
  function show(amount) {
    list.append(...found.slice(shown, shown + amount).map(row));
    shown = Math.min(found.length, shown + amount);
    more.hidden = shown >= found.length;
  }
  function choose() {
    found = attempts.filter((attempt) => (!chosen.state || attempt.state === chosen.state) &&
                                         (chosen.floor === '' || attempt.floor === Number(chosen.floor)));
    found.sort(orders[chosen.order][1]);
    status.textContent = `${count(found.length)} of ${count(attempts.length)} attempts. Times since the start of the log; ` +
        'one chosen is shown on the map, with its line for edits.yaml.';
    list.replaceChildren();
    shown = 0;
    show(100);
  }
  const select = (name, label, options) => element('label', {}, label, element('select', {
    id: `closures-${name}`, onchange: (event) => {
      chosen[name] = event.target.value;
      choose();
    },
  }, options.map(([value, text]) => element('option', {value, selected: chosen[name] === value}, text))));
  page.append(
      element('div', {class: 'filters'},
              select('state', 'State', [['', 'All'], ...present.map((state) => [state, stateName(state)])]),
              select('floor', 'Floor', [['', 'All'], ...floors.map((floor) => [String(floor.index), floor.label])]),
              select('order', 'Order', Object.entries(orders).map(([value, [text]]) => [value, text]))),
      status, list, more);
  choose();
}

export function plotsPage(page, model, onpick) {
  let width = 0;
  const draw = () => {
    const style = getComputedStyle(page);
    const now = Math.floor(page.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight));
    if (page.hidden || now === width || now < 100) return;
    width = now;
    page.replaceChildren(...plots(model, width, onpick));
  };
  new ResizeObserver(draw).observe(page);
  draw();
}

function settingText(value) {
  return typeof value === 'string' ? value || '\u2013' : String(value);
}

export function runPage(page, model) {
  const {summary} = model;
  const {counts} = summary;
  const stages = Object.entries(summary.seconds).filter(([name]) => name !== 'total');
  const slowest = Math.max(...stages.map(([, value]) => value), 1e-9);
  const total = summary.seconds.total;
  const options = Object.entries(summary.options);

  if (model.doubts.length) {
    page.append(part('Doubts', model.doubts.map(({floor, text, edit}) => element('p', {class: 'notice doubt'},
        `Floor ${model.floors[floor].label}: ${text}`, edit ? element('code', {}, edit) : null))));
  }
  if (summary.warnings.length) {
    page.append(part('Warnings', summary.warnings.map((text) => element('p', {class: 'notice'}, text))));
  }
  const share = (name) => summary.options[name];
  const table = element('table', {id: 'table-one'},
      element('caption', {}, `As in Table I of the paper; MinScore ${percent(share('matcher.min_score') ?? 0)}, ` +
          `MaxMaha ${share('candidates.max_maha') ?? '\u2013'}`),
      element('thead', {}, element('tr', {}, element('th', {}, 'Mask'),
          ['Attempted', 'Matched', 'Validated', 'Time'].map((name) => element('th', {class: 'number'}, name)))),
      element('tbody', {}, element('tr', {}, element('td', {class: 'long'}, summary.mask),
          [counts.attempted, counts.matched, counts.validated].map((value) => element('td', {class: 'number'}, count(value))),
          element('td', {class: 'number'}, seconds(total)))));
  const reasons = new Map();
  for (const {state, reason} of model.attempts) {
    if (state !== 'validated') reasons.set(reason || stateName(state), (reasons.get(reason || stateName(state)) ?? 0) + 1);
  }
  const rows = (entries) => element('table', {}, element('tbody', {}, entries.map(([name, value]) =>
      element('tr', {}, element('td', {class: 'long'}, name), element('td', {class: 'number'}, value)))));
  const frequent = [...reasons].sort((a, b) => b[1] - a[1]);
  const search = element('input', {
    type: 'search', id: 'option-search', placeholder: 'Find an option', 'aria-label': 'Find an option',
    style: 'width: 100%; margin-bottom: 6px', oninput: () => {
      for (const tr of optionTable.querySelectorAll('tr')) tr.hidden = !tr.textContent.includes(search.value.trim());
    },
  });
  const optionTable = element('table', {}, element('tbody', {}, options.map(([name, value]) =>
      element('tr', {}, element('td', {class: 'mono long'}, name), element('td', {class: 'mono number long', style: 'white-space: normal'}, settingText(value))))));
  page.append(
      part('Closures', table),
      frequent.length ? part('Attempts that became no closure', rows(frequent.slice(0, 12).map(([name, value]) => [name, count(value)]))) : '',
      part('Time per stage',
           stages.map(([name, value]) => element('div', {class: 'bar'}, element('span', {}, name),
               element('i', {style: `width: ${(100 * value / slowest).toFixed(2)}%`}), element('span', {class: 'number'}, seconds(value)))),
           element('p', {class: 'below'}, `${seconds(total)} in total, ${number(summary.peak_memory_mib, 0)}\u202fMiB of memory at most.`)),
      part('Log', rows([
        ['File', summary.log], ['Motion from', summary.motion_source], ['Observations', count(counts.observations)],
        ['Scans', count(counts.scans)], ['Way driven', distanceText(model.trajectory.length)],
        ['Nodes', `${count(counts.nodes)} (${count(counts.scan_nodes)} with a scan)`],
      ])),
      summary.drives ? part('Drives', rows(summary.drives.map((drive, index) => [
        `${index + 1}: ${drive.log}`,
        drive.joined ? `${count(drive.closures_to_others)} closures to others` : `a piece of its own: ${drive.reason}`,
      ]))) : '',
      options.length ? part('Options used', search, optionTable) : '');
}
