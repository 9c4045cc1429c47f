// SPDX-License-Identifier: BSD-3-Clause
import * as Plot from '@observablehq/plot';
import {clock, element, metres, percent, degrees} from './format.js';
import {key} from './details.js';
import {closureStates, stateName} from './states.js';

const kErrorFloor = 0.001;  // below a millimetre or a thousandth of a degree nothing is told apart

const colourOf = (state) => `var(${closureStates[state].colour})`;

function figure(title, note, legend, svg) {
  return element('figure', {class: 'plot'},
                 element('figcaption', {}, element('h2', {}, title)),
                 note && element('p', {class: 'below'}, note),
                 legend && element('div', {class: 'legend'}, legend), svg);
}

function stateLegend(states) {
  return states.map((state) => element('span', {}, key('area', closureStates[state].colour), stateName(state)));
}

const style = {background: 'none', color: 'var(--quiet)', fontSize: '12px', overflow: 'visible'};

/** Not more points than a line of this width shows; the last one always. */
function thinned(points, most = 800) {
  const stride = Math.ceil(points.length / most);
  return points.filter((_, i) => i % stride === 0 || i === points.length - 1);
}

function overTime(model, width) {
  const series = [
    ['Attempted', '--rejected', () => true], ['Matched', '--hypothesis', ({state}) => state !== 'rejected_score'],
    ['Validated', '--validated', ({state}) => state === 'validated'],
  ];
  const byTime = [...model.attempts].sort((a, b) => a.tA - b.tA);
  const end = model.trajectory.count ? model.trajectory.stamp[model.trajectory.count - 1] : byTime.at(-1).tA;
  const lines = series.map(([name, colour, holds]) => {
    const points = [{t: 0, n: 0, name}];
    for (const attempt of byTime) {
      if (holds(attempt)) points.push({t: (attempt.tA - model.start) / 60, n: points.length, name});
    }
    points.push({t: (end - model.start) / 60, n: points.length - 1, name});
    return {name, colour, points: thinned(points)};
  });
  const plot = Plot.plot({
    width, height: 190, marginLeft: 48, marginRight: 12, style,
    x: {label: 'time of the newer scan (min)', labelAnchor: 'center', labelArrow: 'none'},
    y: {label: 'closures so far', grid: true, labelArrow: 'none', nice: true},
    marks: [
      ...lines.map(({points, colour}) =>
          Plot.lineY(points, {x: 't', y: 'n', stroke: `var(${colour})`, curve: 'step-after', strokeWidth: 1.8})),
      Plot.ruleY([0]),
    ],
  });
  return figure('Closures over time', null,
                lines.map(({name, colour}) => element('span', {}, key('line', colour), name)), plot);
}

function scores(model, width) {
  const states = Object.keys(closureStates).filter((state) => model.attempts.some((attempt) => attempt.state === state));
  const step = 0.025;
  const bins = new Map();
  for (const {score, state} of model.attempts) {
    const bin = Math.min(39, Math.max(0, Math.floor(score / step)));
    const name = `${state} ${bin}`;
    if (!bins.has(name)) bins.set(name, {state, x1: bin * step * 100, x2: (bin + 1) * step * 100, n: 0});
    ++bins.get(name).n;
  }
  const least = model.summary.options['matcher.min_score'];
  const plot = Plot.plot({
    width, height: 190, marginLeft: 48, marginRight: 12, style,
    x: {label: 'score (%)', labelAnchor: 'center', labelArrow: 'none', domain: [0, 100]},
    y: {label: 'attempts', grid: true, labelArrow: 'none'},
    marks: [
      Plot.rectY([...bins.values()], Plot.stackY({
        x1: 'x1', x2: 'x2', y: 'n', fill: ({state}) => colourOf(state), inset: 0.5,
        order: ({state}) => states.indexOf(state),
      })),
      typeof least === 'number' ? Plot.ruleX([least * 100], {stroke: 'var(--ink)', strokeDasharray: '4 3'}) : null,
      Plot.ruleY([0]),
    ],
  });
  plot.querySelectorAll('rect').forEach((rect) => rect.removeAttribute('title'));
  return figure('Scores', typeof least === 'number' ? `Dashed: the least score taken, ${percent(least)}.` : null,
                stateLegend(states), plot);
}

function errors(model, width, onpick) {
  const matched = model.attempts.filter(({error}) => Number.isFinite(error));
  if (!matched.length) return [];
  const states = Object.keys(closureStates).filter((state) => matched.some((attempt) => attempt.state === state));
  const one = (title, note, value, unit, legend) => {
    const dots = matched.map((attempt) =>
        ({attempt, t: (attempt.tA - model.start) / 60, error: Math.max(kErrorFloor, value(attempt))}));
    const plot = Plot.plot({
      width, height: 210, marginLeft: 48, marginRight: 12, style,
      x: {label: 'time of the newer scan (min)', labelAnchor: 'center', labelArrow: 'none'},
      y: {type: 'log', label: `error (${unit})`, grid: true, labelArrow: 'none', ticks: 5,
          tickFormat: (v) => Number.isInteger(Math.log10(v)) || Math.abs(Math.log10(v) % 1) < 1e-9 ? String(v) : ''},
      marks: [
        Plot.dot(dots, {x: 't', y: 'error', r: 2.2, fill: ({attempt}) => colourOf(attempt.state), fillOpacity: 0.75}),
        Plot.tip(dots, Plot.pointer({
          x: 't', y: 'error', fill: 'var(--raised)', stroke: 'var(--line)',
          title: ({attempt}) => `${stateName(attempt.state)}, ${clock(attempt.tA - model.start)}\n` +
              `${metres(attempt.error, 3)}, ${degrees(attempt.angleError)}\nscore ${percent(attempt.score)}`,
        })),
      ],
    });
    plot.addEventListener('click', () => plot.value && onpick(plot.value.attempt));
    return figure(title, note, legend, plot);
  };
  return [
    one('Error per closure', 'How far the finished map puts the two scans from where their match would have them. ' +
        'Logarithmic; a click shows the closure on the map.', ({error}) => error, 'm', stateLegend(states)),
    one('Error per closure, angle', null, ({angleError}) => angleError * 180 / Math.PI, '°', null),
  ];
}

export function plots(model, width, onpick) {
  if (!model.attempts.length) {
    return [element('p', {class: 'below', style: 'padding-top: 14px'}, 'No closure was tried, so there is nothing to plot.')];
  }
  return [overTime(model, width), scores(model, width), ...errors(model, width, onpick)];
}
