// Opens the page of a mechanism in a real, headless browser with software WebGL: it must draw the poses of the scene,
// move, obey buttons and keys, fit a phone, and show the picture where there is no WebGL.
import assert from 'node:assert/strict';
import {mkdtempSync, mkdirSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {callTwinmap} from './fixtures.mjs';
import {launchBrowser, openPage} from './launch.mjs';

const kSoftwareWebgl = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
const kFile = join(process.env.TWINMAP_SOURCE_DIR, 'experiments/mechanisms/spatial_arm.yaml');
const folder = mkdtempSync(join(tmpdir(), 'twinmap_view_'));
let browser;

before(async () => {
  mkdirSync(process.env.TWINMAP_SCREENSHOTS, {recursive: true});
  callTwinmap('view', kFile, '--out', join(folder, 'page.html'));
  browser = await launchBrowser(3, kSoftwareWebgl);
});

after(async () => {
  await browser?.close();
  rmSync(folder, {recursive: true, force: true});
});

async function open(options = {}, prepare = () => {}) {
  const page = await openPage(browser, options);
  page.complaints = [];
  page.on('pageerror', error => page.complaints.push(error.message));
  page.on('request', request => {
    if (!/^(file|data|blob):/.test(request.url())) page.complaints.push(`asks the network for ${request.url()}`);
  });
  await page.addInitScript(prepare);
  await page.goto(`file://${join(folder, 'page.html')}`);
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
        const at = poses.slice((frame * count + i) * 12, (frame * count + i + 1) * 12), m = body.matrixWorld.elements;
        const drawn = [m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10], m[12], m[13], m[14]];
        drawn.forEach((value, k) => { worst = Math.max(worst, Math.abs(value - at[k])); });
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
