// SPDX-License-Identifier: BSD-3-Clause
// node page_test.mjs CHROMIUM REPORT EDITS WAY SPACE: opens a report from disk and uses it as a person would,
// then WAY, the same with a way through the building, and SPACE, of a 3D lidar. The lines that it proposes for a validated closure
// and for a match that was not validated go to EDITS.
import assert from 'node:assert/strict';
import {writeFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const [, , executablePath, report, edits, way, space] = process.argv;
const kPatience = 120000;  // ms; everything is drawn by the processor

const browser = await chromium.launch({
  executablePath, timeout: kPatience,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});
try {
  const page = await browser.newPage({viewport: {width: 900, height: 600}, reducedMotion: 'reduce'});
  page.setDefaultTimeout(kPatience);
  const address = pathToFileURL(report).href;
  const requests = [];
  const complaints = [];
  page.on('request', (request) => requests.push(request.url()));
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('dialog', (dialog) => {
    complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on('console', (message) => {
    // Reading a picture back, which only this test does, is slow on a processor and said so.
    if (message.type() === 'error' || (message.type() === 'warning' && !message.text().includes('GPU stall'))) {
      complaints.push(message.text());
    }
  });
  await page.goto(address);
  await page.waitForSelector('html[data-ready=true]');

  const picture = async () => {
    await page.mouse.move(1, 1);
    // Two frames: what was asked for is drawn in the next one.
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    const png = await page.locator('#canvas canvas').screenshot({timeout: kPatience});
    return png.toString('base64');
  };
  const coloursIn = (png) => page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const {data} = context.getImageData(0, 0, image.width, image.height);
    const colours = new Map();
    for (let i = 0; i < data.length; i += 4) {
      const colour = data[i] << 16 | data[i + 1] << 8 | data[i + 2];
      colours.set(colour, (colours.get(colour) ?? 0) + 1);
    }
    return {different: colours.size, background: Math.max(...colours.values()) * 4 / data.length};
  }, png);

  const whole = await picture();
  const {different, background} = await coloursIn(whole);
  assert.ok(different > 50, `the map is drawn in ${different} colours only`);
  assert.ok(background < 0.98, `${(background * 100).toFixed(1)} % of the map are empty`);

  assert.ok(await page.locator('#floors input').count() >= 2, 'the office has two floors');
  await page.locator('#floor-1').uncheck();
  const oneFloor = await picture();
  assert.notEqual(oneFloor, whole, 'a floor taken away changes nothing');
  await page.locator('#floor-1').check();
  assert.equal(await picture(), whole, 'a floor put back is not as it was');

  await page.locator('input[name=blend][value=before]').check({force: true});
  await page.waitForSelector('html[data-blend="0"]');
  const before = await picture();
  assert.notEqual(before, whole, 'before and after are the same');
  assert.ok((await coloursIn(before)).different > 50, 'nothing is drawn before optimisation');
  await page.locator('input[name=blend][value=after]').check({force: true});
  await page.waitForSelector('html[data-blend="1"]');
  assert.equal(await picture(), whole, 'after is not as it was');

  await page.locator('#separation').focus();
  await page.keyboard.press('End');
  assert.notEqual(await picture(), whole, 'floors do not come apart');
  await page.locator('#canvas').focus();
  const apart = await picture();
  await page.keyboard.press('ArrowLeft');
  assert.notEqual(await picture(), apart, 'the arrow keys do not turn the map');

  await page.locator('#tab-map').focus();
  await page.keyboard.press('ArrowRight');
  assert.ok(await page.locator('#page-closures').isVisible());
  const proposed = async (state) => {
    await page.locator('#closures-state').selectOption(state);
    await page.locator('.closures button').first().click();
    return page.locator('#selection code').textContent();
  };
  const addition = await proposed('hypothesis');
  assert.match(addition, /^- add_closure: \{from: [\d.]+, to: [\d.]+, transform: \[[-\d., ]+\]\}$/);
  const removal = await proposed('validated');
  assert.match(removal, /^- forbid_closure: \{from: [\d.]+, to: [\d.]+\}$/);
  writeFileSync(edits, `${addition}\n${removal}\n`);
  await page.keyboard.press('Escape');
  assert.ok(await page.locator('#selection').isHidden());

  await page.locator('#tab-plots').click();
  await page.waitForSelector('figure.plot svg');
  assert.equal(await page.locator('figure.plot').count(), 4);
  await page.locator('#tab-run').click();
  assert.match(await page.locator('#table-one').textContent(), /Attempted.*Matched.*Validated.*Time/);
  assert.match(await page.locator('#title').textContent(), /<script>alert\(1\)<!--/);

  assert.equal(await page.locator('#layer-route').count(), 0, 'a way where none was asked for');
  assert.equal(await page.locator('#band-low').count(), 0, 'heights where no lidar saw any');
  await page.goto(pathToFileURL(way).href);
  await page.waitForSelector('html[data-ready=true]');
  const withWay = await picture();
  await page.locator('#layer-route').uncheck();
  assert.notEqual(await picture(), withWay, 'the way is not drawn');
  assert.match(await page.locator('label:has(#layer-route)').textContent(), /Way of [\d.]+.m/);

  await page.goto(pathToFileURL(space).href);
  await page.waitForSelector('html[data-ready=true]');
  assert.match(await page.locator('label:has(#layer-space)').textContent(), /Points of the 3D lidar.*\d/);
  const low = page.getByRole('slider', {name: 'From, above the floor'});
  const high = page.getByRole('slider', {name: 'To, above the floor'});
  assert.match(await low.getAttribute('aria-valuetext'), /^0\.20.m$/);
  const usual = await picture();
  await high.focus();
  await page.keyboard.press('End');
  const withCeiling = await picture();
  assert.notEqual(withCeiling, usual, 'the ceiling does not come with the height of the band');
  await page.keyboard.press('Home');
  assert.equal(await low.inputValue(), await high.inputValue(), 'the ends of the band pass each other');
  await page.keyboard.press('End');
  const withFloor = await picture();
  assert.notEqual(withFloor, withCeiling, 'the floor does not come with the depth of the band');
  await page.locator('#layer-space').uncheck();
  assert.notEqual(await picture(), withFloor, 'points that are not shown are drawn');

  assert.deepEqual(complaints, []);
  assert.deepEqual(requests.filter((url) => url !== address && ![way, space].some((file) => url === pathToFileURL(file).href) && !/^(data|blob):/.test(url)), []);
  console.log('the page is as it should be');
} finally {
  await browser.close();
}
