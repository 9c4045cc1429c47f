// SPDX-License-Identifier: BSD-3-Clause
import {readReport} from './data.js';
import {details, editElement} from './details.js';
import {count, distanceText, element} from './format.js';
import {closuresPage, mapPage, plotsPage, runPage} from './panel.js';
import {MapScene} from './scene.js';

const byId = (id) => document.getElementById(id);
const calm = matchMedia('(prefers-reduced-motion: reduce)');

/** Floors that hide each other are pulled apart from the start. */
function initialSeparation(model, extent) {
  return model.floors.length > 1 ? Math.round(extent * 0.12 * 2) / 2 : 0;
}

function followTheme(onchange) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const apply = () => {
    document.documentElement.dataset.theme = dark.matches ? 'dark' : 'light';
    onchange();
  };
  dark.addEventListener('change', apply);
  apply();
}

function makeScene(model) {
  try {
    return new MapScene(byId('canvas'), model);
  } catch (error) {
    byId('canvas').hidden = true;
    byId('scale').hidden = true;
    byId('no-webgl').hidden = false;
    console.warn(error.message);
    return null;
  }
}

function followScale(scene) {
  const scale = byId('scale').firstElementChild;
  scene.onrender = (pixelsPerMetre) => {
    if (!Number.isFinite(pixelsPerMetre) || pixelsPerMetre <= 0) return;
    const wanted = 110 / pixelsPerMetre;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].find((factor) => factor * power <= wanted) * power;
    scale.style.width = `${(length * pixelsPerMetre).toFixed(1)}px`;
    scale.textContent = length >= 1 ? `${length}\u202fm` : `${Math.round(length * 100)}\u202fcm`;
  };
}

/** Moves from one set of poses to the other, so that the eye can follow. */
function makeBlend(scene) {
  let running = 0;
  return (name) => {
    if (!scene) return;
    const target = name === 'after' ? 1 : 0;
    const from = scene.blend;
    const run = ++running;
    const start = performance.now();
    const lasts = calm.matches ? 0 : 1200;
    const step = (now) => {
      if (run !== running) return;
      const t = lasts ? Math.min(1, Math.max(0, (now - start) / lasts)) : 1;
      const eased = t * t * (3 - 2 * t);
      scene.setBlend(t === 1 ? target : from + (target - from) * eased);
      document.documentElement.dataset.blend = String(scene.blend);
      if (t < 1) requestAnimationFrame(step);
    };
    step(start);
  };
}

function makeSelection(model, scene) {
  const card = byId('selection');
  return function select(item, go = false) {
    scene?.select(item);
    card.hidden = !item;
    if (!item) return;
    card.replaceChildren(
        element('button', {type: 'button', class: 'close', 'aria-label': 'Close', onclick: () => select(null)}, '\u00d7'),
        ...details(model, item), ...(item.attempt ? editElement(item.attempt) : []));
    if (go) scene?.goTo(item);
  };
}

function followPointer(model, scene, select) {
  const canvas = scene.renderer.domElement;
  const tooltip = byId('tooltip');
  let pressed = null;
  let last = null;
  const show = () => {
    const event = last;
    last = null;
    if (!event) return;
    const item = scene.pick(event.clientX, event.clientY);
    tooltip.hidden = !item;
    canvas.style.cursor = item ? 'pointer' : 'grab';
    if (!item) return;
    tooltip.replaceChildren(...details(model, item));
    const frame = canvas.getBoundingClientRect();
    const {width, height} = tooltip.getBoundingClientRect();
    const x = event.clientX - frame.left;
    const y = event.clientY - frame.top;
    tooltip.style.left = `${x + 16 + width < frame.width ? x + 16 : Math.max(4, x - 16 - width)}px`;
    tooltip.style.top = `${Math.min(Math.max(4, y + 14), frame.height - height - 4)}px`;
  };
  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons) {
      tooltip.hidden = true;
      return;
    }
    if (!last) requestAnimationFrame(show);
    last = event;
  });
  canvas.addEventListener('pointerleave', () => { last = null; tooltip.hidden = true; });
  canvas.addEventListener('pointerdown', (event) => {
    pressed = [event.clientX, event.clientY];
    byId('canvas').focus({preventScroll: true});
  });
  canvas.addEventListener('pointerup', (event) => {
    if (!pressed || event.button !== 0) return;
    if (Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4) {
      tooltip.hidden = true;
      select(scene.pick(event.clientX, event.clientY));
    }
    pressed = null;
  });
}

function followTabs() {
  const tabs = [...document.querySelectorAll('[role="tab"]')];
  const choose = (chosen) => {
    for (const tab of tabs) {
      const selected = tab === chosen;
      tab.setAttribute('aria-selected', String(selected));
      tab.tabIndex = selected ? 0 : -1;
      byId(tab.getAttribute('aria-controls')).hidden = !selected;
    }
    document.body.classList.toggle('wide', chosen.id === 'tab-plots');
  };
  tabs.forEach((tab, i) => {
    tab.addEventListener('click', () => choose(tab));
    tab.addEventListener('keydown', (event) => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (!step) return;
      const next = tabs[(i + step + tabs.length) % tabs.length];
      choose(next);
      next.focus();
    });
  });
}

function main() {
  const model = readReport(byId('report-data').textContent);
  byId('report-data').remove();  // its megabytes are not needed twice
  const {summary} = model;
  const name = summary.log.split('/').pop() || 'Map';
  document.title = `${name} \u2013 Masked Mapper`;
  byId('title').textContent = name;
  byId('subtitle').textContent = [
    `${distanceText(model.trajectory.length)} driven`,
    `${model.floors.length} ${model.floors.length === 1 ? 'floor' : 'floors'}`,
    `${count(summary.counts.nodes)} nodes`, `${count(summary.counts.validated)} closures`, `mask ${summary.mask}`,
  ].join(' \u00b7 ');

  let scene = null;
  followTheme(() => scene?.applyTheme());
  scene = makeScene(model);
  model.origin = scene ? [scene.origin.x, scene.origin.y] : [0, 0];
  const separation = scene ? initialSeparation(model, scene.extent) : 0;
  if (scene) {
    scene.setSeparation(separation);
    scene.look();
    followScale(scene);
  }
  const select = makeSelection(model, scene);
  const pick = (attempt) => select({attempt}, true);
  if (scene) followPointer(model, scene, select);
  addEventListener('keydown', (event) => {
    if (event.key === 'Escape') select(null);
  });
  mapPage(byId('page-map'), model, scene, {blendTo: makeBlend(scene), separation});
  closuresPage(byId('page-closures'), model, pick);
  plotsPage(byId('page-plots'), model, pick);
  runPage(byId('page-run'), model);
  const notices = summary.warnings.length + model.doubts.length;
  if (notices) {
    byId('tab-run').append(element('span', {
      class: 'badge', 'aria-label': `${model.doubts.length} doubts, ${summary.warnings.length} warnings`,
    }, String(notices)));
  }
  followTabs();
  document.documentElement.dataset.blend = '1';
  document.documentElement.dataset.ready = 'true';
}

main();
