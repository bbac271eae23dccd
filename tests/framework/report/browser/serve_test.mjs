// Opens the live page of `twinmap serve` in a real, headless browser, before a twin that counts: it must follow the
// measurements, obey the keyboard, fit a phone, ask nobody else, and have no serious fault of accessibility (axe-core).
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdirSync, readFileSync} from 'node:fs';
import {Agent, request} from 'node:http';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {createInterface} from 'node:readline';
import {after, before, test} from 'node:test';
import {launchBrowser, openPage} from './launch.mjs';

const kAxe = createRequire(join(process.env.TWINMAP_PLAYWRIGHT, 'index.js')).resolve('axe-core/axe.min.js');
const kScreenshots = process.env.TWINMAP_SCREENSHOTS;
const kMany = 2000;
let browser;

before(async () => {
  mkdirSync(kScreenshots, {recursive: true});
  browser = await launchBrowser();
});
after(() => browser?.close());

/** A server of its own: {url, post(count), end()}. */
async function serve() {
  const server = spawn(process.env.TWINMAP_FAKE_TWIN, ['0'], {stdio: ['pipe', 'pipe', 'inherit']});
  const [port] = await new Promise(resolve => createInterface(server.stdout).once('line', line => resolve([line])));
  const agent = new Agent({keepAlive: true, maxSockets: 1});
  const postOne = name => new Promise((resolve, reject) => {
    const options = {port, agent, method: 'POST', path: `/measurements?name=${name}`, headers: {'Content-Type': 'text/csv'}};
    const posted = request(options, response => {
      response.resume();
      response.on('end', () => resolve(response.statusCode));
    });
    posted.on('error', reject);
    posted.end('t,x\n0,1\n');
  });
  return {
    url: `http://localhost:${port}/`,
    async post(count) {
      for (let i = 0; i < count; ++i) assert.equal(await postOne(`m${i}.csv`), 200);
    },
    async end() {
      agent.destroy();
      server.stdin.end();
      await new Promise(resolve => server.once('exit', resolve));
    }
  };
}

/** Whatever the console says is an error, and so is a request to anyone else. */
async function open(server, options = {}) {
  const page = await openPage(browser, options);
  page.complaints = [];
  page.on('console', message => page.complaints.push(message.text()));
  page.on('pageerror', error => page.complaints.push(error.message));
  page.on('request', asked => {
    if (!asked.url().startsWith(server.url) && !asked.url().startsWith('data:')) page.complaints.push(asked.url());
  });
  await page.goto(server.url);
  await page.waitForFunction(() => document.getElementById('connection').textContent === 'live');
  return page;
}

async function close(page, server) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await server.end();
}

const waitForCount = (page, count) => page.waitForFunction(expected =>
    document.getElementById('summary').textContent.startsWith(`${expected} measurement`), count);

test(`follows ${kMany} measurements to the last`, async () => {
  const server = await serve();
  const page = await open(server);
  await server.post(kMany);
  await waitForCount(page, kMany);
  assert.match(await page.locator('#now tbody').textContent(), /k "0"N\/m95/);
  assert.match(await page.locator('#alarms').textContent(), /a step of 3/);
  assert.match(await page.locator('#last tbody tr').first().textContent(), new RegExp(`^${kMany}m${kMany - 1}.csvok`));
  await page.waitForFunction(() => document.querySelectorAll('#charts svg .mean').length === 1);
  await close(page, server);
});

test('pauses by keyboard, and goes on with the newest', async () => {
  const server = await serve();
  const page = await open(server);
  await server.post(1);
  await waitForCount(page, 1);
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'pause');
  await page.keyboard.press('Enter');
  assert.equal(await page.getAttribute('#pause', 'aria-pressed'), 'true');
  await server.post(2);
  assert.match(await page.textContent('#summary'), /^1 measurement/);
  await page.keyboard.press('Space');
  await waitForCount(page, 3);
  await close(page, server);
});

test('says that the server is gone', async () => {
  const server = await serve();
  const page = await open(server);
  await server.end();
  await page.waitForFunction(() => /^disconnected/.test(document.getElementById('connection').textContent));
  await page.context().close();
});

for (const colorScheme of ['light', 'dark']) {
  test(`fits a phone and has no serious fault, ${colorScheme}`, async () => {
    const server = await serve();
    await server.post(20);
    const page = await open(server, {colorScheme, viewport: {width: 400, height: 800}});
    await page.waitForFunction(() => document.querySelectorAll('#charts svg .mean').length === 1);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth));
    await page.screenshot({path: join(kScreenshots, `serve-${colorScheme}.png`), fullPage: true});
    await page.evaluate(readFileSync(kAxe, 'utf8'));
    const found = await page.evaluate(() => window.axe.run());
    assert.deepEqual(found.violations.map(({id, impact, nodes}) => `${id} (${impact}): ${nodes[0].html}`), []);
    await close(page, server);
  });
}
