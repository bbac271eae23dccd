// Opens the page of a mechanism in a real, headless browser with software WebGL: it must draw the poses of the scene,
// move, obey buttons and keys, fit a phone, have no serious fault of accessibility (axe-core), and show the picture where
// there is no WebGL.
import assert from 'node:assert/strict';
import {mkdtempSync, mkdirSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {callTwinmap} from './fixtures.mjs';
import {launchBrowser, openPage} from './launch.mjs';

const kSoftwareWebgl = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
const kFile = join(process.env.TWINMAP_SOURCE_DIR, 'experiments/mechanisms/spatial_arm.yaml');
const folder = mkdtempSync(join(tmpdir(), 'twinmap_view_'));
const kAxe = createRequire(join(process.env.TWINMAP_PLAYWRIGHT, 'index.js')).resolve('axe-core/axe.min.js');
let browser;

/** A pendulum with a shape, whose measurement is of another machine than the model may be. */
const kPendulum = `
name: pendulum
parameters: {g: {bounds: [9.7, 9.9], unit: m/s2}}
system:
  gravity: [0, 0, -g]
  bodies:
    arm:
      mass: 2
      center_of_mass: [0, 0, -0.5]
      inertia: {moments: [0.2, 0.3, 0.25]}
      joint: {type: pin, axis: [0, 1, 0], coordinates: [q]}
      shapes: [{box: [0.1, 0.1, 1], point: [0, 0, -0.5]}, {sphere: 0.1}, {cylinder: {radius: 0.05, length: 0.3}},
        {capsule: {radius: 0.05, length: 0.3}}]
    bob: {mass: 1, joint: {type: weld, parent: arm, in_parent: {point: [0, 0, -1]}}}
initial: {coordinates: {q: 0.4}}
outputs: {q: {coordinate: q}}
simulation: {duration: 2}
features: [{samples: {outputs: [q], start: 0, interval: 0.01, count: 201}}]
noise: {stddev: {q: 1e-3}}
`;

function makeMeasured() {
  writeFileSync(join(folder, 'pendulum.yaml'), kPendulum);
  callTwinmap('simulate', join(folder, 'pendulum.yaml'), 'parameters.g=9.1', '--noise', '--csv', join(folder, 'm.csv'));
  callTwinmap('view', join(folder, 'pendulum.yaml'), join(folder, 'm.csv'), '--out', join(folder, 'measured.html'));
}

before(async () => {
  mkdirSync(process.env.TWINMAP_SCREENSHOTS, {recursive: true});
  callTwinmap('view', kFile, '--out', join(folder, 'page.html'));
  makeMeasured();
  browser = await launchBrowser(3, kSoftwareWebgl);
});

after(async () => {
  await browser?.close();
  rmSync(folder, {recursive: true, force: true});
});

async function open(options = {}, prepare = () => {}, file = 'page.html') {
  const page = await openPage(browser, options);
  page.complaints = [];
  page.on('pageerror', error => page.complaints.push(error.message));
  page.on('request', request => {
    if (!/^(file|data|blob):/.test(request.url())) page.complaints.push(`asks the network for ${request.url()}`);
  });
  await page.addInitScript(prepare);
  await page.goto(`file://${join(folder, file)}`);
  await page.waitForFunction(() => window.twinmap !== undefined);
  return page;
}

async function close(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}

const getTime = page => page.evaluate(() => window.twinmap.state.time);
const readPixels = page => page.evaluate(() => {
  window.twinmap.stage.render();
  return document.querySelector('#stage canvas').toDataURL();
});

test('the poses that are drawn are those of the scene', async () => {
  const page = await open();
  const worst = await page.evaluate(() => {
    const {scene, stage, setTime} = window.twinmap;
    const count = scene.bodies.length, poses = scene.motions[0].poses;
    let worst = 0;
    for (const frame of [0, 57, scene.times.length - 1]) {
      setTime(scene.times[frame]);
      stage.render();
      stage.machines[0].bodies.forEach((body, i) => {
        const [x, y, z, w, ...origin] = poses.slice((frame * count + i) * 7, (frame * count + i + 1) * 7);
        const m = body.matrixWorld.elements;
        const drawn = [m[0], m[1], m[6], m[8], m[10], m[12], m[13], m[14]];
        const at = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (y * z + x * w), 2 * (x * z + y * w), 1 - 2 * (x * x + y * y)];
        [...at, ...origin].forEach((value, k) => { worst = Math.max(worst, Math.abs(value - drawn[k])); });
      });
    }
    return worst;
  });
  assert.ok(worst < 1e-6, `${worst}`);
  await page.screenshot({path: join(process.env.TWINMAP_SCREENSHOTS, 'view.png')});
  await close(page);
});

test('pixels move with the time, by the button and by keys', async () => {
  const page = await open();
  const before = await readPixels(page);
  await page.getByRole('button', {name: 'Play'}).click();
  await page.waitForFunction(() => window.twinmap.state.time > 0.2);
  await page.getByRole('button', {name: 'Pause'}).click();
  await page.waitForTimeout(100);
  assert.notEqual(await readPixels(page), before);
  await page.locator('h1').click();
  const paused = await getTime(page);
  await page.keyboard.press('ArrowRight');
  assert.ok(await getTime(page) > paused);
  await page.keyboard.press('Home');
  assert.equal(await getTime(page), 0);
  await page.keyboard.press('l');
  await page.waitForFunction(() => [...document.querySelectorAll('.label')].every(label => label.style.display === 'none'));
  await close(page);
});

test('the page fits a phone, and shows the picture without WebGL and in print', async () => {
  const phone = await open({viewport: {width: 400, height: 800}});
  assert.ok(await phone.evaluate(() => document.documentElement.scrollWidth) <= 400);
  await phone.emulateMedia({media: 'print'});
  assert.ok(await phone.locator('#picture svg').isVisible());
  await close(phone);
  const plain = await open({}, () => { HTMLCanvasElement.prototype.getContext = () => null; });
  assert.ok(await plain.locator('#picture svg').isVisible());
  assert.ok(!await plain.locator('#stage').isVisible());
  await close(plain);
});

test('what was measured moves beside the models, and residuals colour the body that they belong to', async () => {
  const page = await open({}, undefined, 'measured.html');
  assert.equal(await page.evaluate(() => window.twinmap.stage.machines.length), 3);
  await page.evaluate(() => window.twinmap.setTime(1.3));
  const getReds = () => page.evaluate(() => [0, 1].map(i => window.twinmap.stage.machines[i].shapes[1].material.color.r));
  const [nominal, updated] = await getReds();
  assert.ok(updated > nominal + 0.2, `${nominal} ${updated}`); // away from green
  assert.match(await page.locator('.label').nth(1).textContent(), /^arm \d+\.\d sd$/);
  await page.screenshot({path: join(process.env.TWINMAP_SCREENSHOTS, 'view-measured.png')});
  await page.getByRole('button', {name: 'Residual'}).click();
  assert.ok((await getReds())[1] < updated - 0.2);
  assert.equal(await page.locator('#plots .dots').count(), 1);
  await close(page);
});

test('modes vibrate, alone', async () => {
  const page = await open({}, undefined, 'measured.html');
  await page.getByLabel('motion').selectOption({index: 1});
  await page.waitForFunction(() => window.twinmap.state.time > 0.1);
  const [frequency, visible] = await page.evaluate(() =>
      [window.twinmap.scene.modes[0].frequency, window.twinmap.stage.machines.map(machine => machine.root.visible)]);
  const inertia = 0.3 + 2 * 0.5 ** 2 + 1; // about the pin
  assert.ok(Math.abs(frequency - Math.sqrt(9.8 * 2 / inertia) / (2 * Math.PI)) < 1e-6, `${frequency}`);
  assert.deepEqual(visible, [true, false, false]);
  await page.getByLabel('motion').selectOption({index: 0});
  assert.deepEqual(await page.evaluate(() => window.twinmap.stage.machines.map(machine => machine.root.visible)), [true, true, true]);
  await close(page);
});

for (const colorScheme of ['light', 'dark']) {
  test(`axe-core finds nothing serious, ${colorScheme}`, async () => {
    for (const file of ['page.html', 'measured.html']) {
      const page = await open({colorScheme}, undefined, file);
      await page.addScriptTag({path: kAxe});
      const found = await page.evaluate(() => window.axe.run());
      assert.deepEqual(found.violations.map(({id, impact, nodes}) => `${id} (${impact}): ${nodes[0].html}`), []);
      await close(page);
    }
  });
}
