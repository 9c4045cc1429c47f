// SPDX-License-Identifier: BSD-3-Clause
// node build.mjs FOLDER: one page of page.html, style.css and the bundle of main.js, with the
// licences of every package that is in it.
import {existsSync, mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {build} from 'esbuild';

const folder = process.argv[2] ?? 'dist';
const read = (path) => readFileSync(path, 'utf8');

async function bundle(entry) {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: 'iife',  // a classic script: modules do not load from file://
    target: 'es2022',
    charset: 'ascii',
    legalComments: 'none',  // licences stand in full beside the page, and in it
    metafile: true,
    write: false,
  });
  return {text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs)};
}

function packagesOf(inputs) {
  const names = new Set();
  for (const input of inputs) {
    const match = input.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
    if (match) names.add(match[1]);
  }
  return [...names].sort();
}

function licences(names) {
  const parts = names.map((name) => {
    const root = join('node_modules', name);
    const about = JSON.parse(read(join(root, 'package.json')));
    const file = ['LICENSE', 'LICENSE.md', 'LICENSE.txt', 'license'].find((candidate) =>
        existsSync(join(root, candidate)));
    if (!file && !about.license) throw new Error(`${name} says nothing about its licence`);
    const text = file ? read(join(root, file)).trim() : `Licence: ${about.license}`;
    return `${name} ${about.version} (${about.license})\n\n${text}\n`;
  });
  return `The page of report.html contains these packages.\n\n${parts.join(`\n${'-'.repeat(72)}\n\n`)}`;
}

const script = await bundle('src/main.js');
const style = await bundle('src/style.css');
const licenceText = licences(packagesOf(script.inputs));
if (/<\/script|<!--/i.test(script.text)) throw new Error('the bundle would end its own element');
const parts = {
  LICENSES: licenceText.replaceAll('--', '- -').replaceAll('>', '&gt;'),
  STYLE: style.text,
  SCRIPT: script.text,
};
// A function as replacement: `$&` in a bundle means nothing.
const page = read('src/page.html').replace(/@(LICENSES|STYLE|SCRIPT)@/g, (_, name) => parts[name]);
if (page.split('@REPORT_DATA@').length !== 2) throw new Error('the place of the data is not unique');
mkdirSync(folder, {recursive: true});
writeFileSync(join(folder, 'viewer.html'), page);
writeFileSync(join(folder, 'LICENSES.txt'), licenceText);
console.log(`${join(folder, 'viewer.html')}: ${(page.length / 1024).toFixed(0)} KiB`);
