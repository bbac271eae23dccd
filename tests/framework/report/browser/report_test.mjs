// Opens reports in a real, headless browser: they must draw everything, say what the files say, link their figures,
// and fit the window. Screenshots go to TWINMAP_SCREENSHOTS.
import assert from 'node:assert/strict';
import {mkdtempSync, mkdirSync, readFileSync, rmSync, statSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {kNames, kSweep, kTestSamples, makeDiagnosis, makeHistory, makeRun, makeRunWithFailures, makeRunWithLongNames,
        makeRunWithSprings, makeSweep, callTwinmap, readCsv} from './fixtures.mjs';
import {launchBrowser, openPage} from './launch.mjs';

const kScreenshots = process.env.TWINMAP_SCREENSHOTS;
const folder = mkdtempSync(join(tmpdir(), 'twinmap_browser_'));
let browser;

before(async () => {
  mkdirSync(kScreenshots, {recursive: true});
  makeRun(join(folder, 'run'));
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, {recursive: true, force: true});
});

/** Opens a report; whatever the console says is an error. */
async function openUndrawn(path, options = {}, prepare = () => {}) {
  const page = await openPage(browser, options);
  page.complaints = [];
  page.on('console', message => page.complaints.push(message.text()));
  page.on('pageerror', error => page.complaints.push(error.message));
  page.on('request', request => {
    if (!/^(file|data|blob):/.test(request.url())) page.complaints.push(`asks the network for ${request.url()}`);
  });
  await page.addInitScript(prepare);
  await page.goto(`file://${join(folder, path)}`);
  return page;
}

/** Opens a report and waits until all of it is drawn, which nobody has to scroll for. */
async function open(path, options = {}) {
  const page = await openUndrawn(path, options);
  await page.waitForSelector('html[data-drawn=true]', {state: 'attached'});
  return page;
}

async function close(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}

const findMarks = (panel, mark, filter = '') => `#${panel} .mark-${mark}.role-mark path${filter}`;

/** Number of marks of a panel: symbols, rules, lines, rects ... */
const countMarks = (page, ...marks) => page.locator(findMarks(...marks)).count();

/** Until a panel has as many marks. */
const waitForMarks = (page, count, ...marks) => page.waitForFunction(([selector, expected]) =>
    document.querySelectorAll(selector).length === expected, [findMarks(...marks), count]);

/** Until the page says how many samples are highlighted. */
const waitForSelection = (page, count) => page.waitForFunction(expected =>
    document.getElementById('selection-text').textContent.startsWith(`${expected} highlighted: `), count);

async function assertEverythingDrawn(page) {
  const panels = await page.locator('figure:not([hidden]) .panel').evaluateAll(elements => elements.map(element => ({
    id: element.id, drawn: element.dataset.drawn, marks: element.querySelectorAll('.role-mark path, .role-mark text').length,
    label: element.getAttribute('aria-label'), role: element.getAttribute('role')
  })));
  assert.ok(panels.length > 0);
  for (const panel of panels) {
    assert.equal(panel.drawn, 'true', `${panel.id} is not drawn`);
    assert.ok(panel.marks > 0, `${panel.id} has no marks`);
    assert.ok(panel.label && panel.role, `${panel.id} has no text for those who cannot see it`);
  }
}

async function assertFits(page, name) {
  const wide = await page.evaluate(() => {
    const most = document.documentElement.clientWidth;
    const scrolls = element => element.closest('.scroll');
    return [document.documentElement.scrollWidth > most ? 'page' : null,
            ...[...document.querySelectorAll('main *')].filter(element => !scrolls(element) &&
                element.getBoundingClientRect().right > most + 1).map(element => element.outerHTML.slice(0, 80))]
        .filter(Boolean);
  });
  assert.deepEqual(wide, [], `${name} is wider than its window`);
}

/** Mean of "rgb(r, g, b)". */
const brightness = color => color.match(/[0-9.]+/g).slice(0, 3).reduce((sum, part) => sum + Number(part) / 3, 0);

async function screenshot(page, name) {
  await page.screenshot({path: join(kScreenshots, `${name}.png`), fullPage: true});
}

test('a run draws every figure with a mark for each of its data', async () => {
  const page = await open('run/report.html');
  await assertEverythingDrawn(page);
  const run = name => join(folder, 'run', name);
  for (const p of kNames.keys()) {
    assert.equal(await countMarks(page, `inferred-${p}`, 'symbol'), kTestSamples);
    assert.equal(await countMarks(page, `inferred-${p}`, 'rule'), 0); // bars are lines, counted next
    assert.equal(await page.locator(`#inferred-${p} .mark-rule.role-mark line`).count(), kTestSamples);
    assert.equal(await countMarks(page, `errors-${p}`, 'symbol'), kTestSamples);
    assert.equal(await countMarks(page, `z-scores-${p}`, 'symbol'), kTestSamples);
    assert.equal(await countMarks(page, `hyperparameters-${p}`, 'symbol'), 3);
  }
  assert.equal(await countMarks(page, 'stddev-0', 'symbol'), kTestSamples);
  assert.equal(await countMarks(page, 'reliability-0', 'line'), kNames.length + 1); // and the diagonal
  assert.equal(await countMarks(page, 'starts-0', 'symbol'), readCsv(run('training.csv')).length);
  assert.equal(await countMarks(page, 'correlations-0', 'rect'), kNames.length ** 2);
  assert.equal(await countMarks(page, 'sensitivities-0', 'line'), kNames.length);
  const stages = Object.keys(JSON.parse(readFileSync(run('provenance.json'))).seconds);
  assert.equal(await countMarks(page, 'stages-0', 'rect'), stages.length);
  for (const index of [0, 1, 2]) {
    assert.equal(await countMarks(page, `response-${index}-0`, 'line'), 2);    // nominal, updated
    assert.equal(await countMarks(page, `response-${index}-0`, 'symbol'), 50); // measured
    assert.equal(await countMarks(page, `response-${index}-2`, 'symbol'), 50); // residuals
  }
  await close(page);
});

test('PIT histograms count the samples', async () => {
  const page = await open('run/report.html');
  const samples = readCsv(join(folder, 'run/figures/samples.csv'));
  for (const [p, name] of kNames.entries()) {
    const bins = new Set(samples.map(row => Math.min(9, Math.floor(10 * row[`pit_${name}`]))));
    // A bar for each bin that has samples, one for the highlighted ones within it, and the band.
    assert.equal(await countMarks(page, `pit-${p}`, 'rect'), 2 * bins.size + 1);
  }
  await close(page);
});

test('the table says what metrics.csv says, sorts, and copies', async () => {
  const page = await open('run/report.html');
  const metrics = readCsv(join(folder, 'run/metrics.csv'));
  const columns = {'bias %': 'bias_pct', 'sd %': 'sd_pct', 'MARE %': 'mare_pct', 'cov. 95 %': 'coverage95',
                   'lower': 'lower', 'upper': 'upper', 'claimed sd %': 'stddev_pct', 'sd of z': 'z_sd', 'NLPD': 'nlpd'};
  const headings = await page.locator('#metrics-table th').allTextContents();
  for (const [heading, column] of Object.entries(columns)) {
    const index = headings.indexOf(heading);
    assert.ok(index >= 0, `no column ${heading}`);
    const cells = page.locator(`#metrics-table tbody td:nth-child(${index + 1})`);
    for (const [row, metric] of metrics.entries()) {
      assert.equal(await cells.nth(row).getAttribute('data-value'), metric[column]);
      const shown = (await cells.nth(row).textContent()).split('(')[0];
      const rounding = Math.max(5.01e-4 * Math.abs(metric[column]), 0.06 * (metric[`${column}_se`] || 0));
      assert.ok(Math.abs(shown - metric[column]) <= rounding, `${shown} for ${metric[column]}`);
    }
  }
  await page.evaluate(() => document.querySelectorAll('details').forEach(folded => { folded.open = true; }));
  const index = headings.indexOf('sd %');
  const button = page.locator('#metrics-table th button').nth(index);
  const readColumn = () => page.locator(`#metrics-table tbody td:nth-child(${index + 1})`)
      .evaluateAll(cells => cells.map(cell => Number(cell.dataset.value)));
  await button.focus();
  await page.keyboard.press('Enter');
  assert.deepEqual(await readColumn(), metrics.map(row => Number(row.sd_pct)).sort((a, b) => a - b));
  await button.click();
  assert.deepEqual(await readColumn(), metrics.map(row => Number(row.sd_pct)).sort((a, b) => b - a));
  assert.equal(await page.locator('#metrics-table th').nth(index).getAttribute('aria-sort'), 'descending');

  await page.evaluate(() => {
    window.copied = [];
    Object.defineProperty(navigator, 'clipboard', {value: {writeText: async text => { window.copied.push(text); }}});
  });
  for (const format of ['csv', 'markdown', 'latex']) {
    await page.locator(`[data-copy=metrics-${format}]`).click();
  }
  await page.waitForFunction(() => window.copied.length === 3);
  const [csv, markdown, latex] = await page.evaluate(() => window.copied);
  assert.equal(csv, readFileSync(join(folder, 'run/metrics.csv'), 'utf8'));
  assert.match(markdown, /^\| parameter \| unit +\| +lower/);
  assert.match(latex, /d\\_theta & N m s\/rad &/);
  await close(page);
});

test('gates and hostile texts are shown as they are', async () => {
  const page = await open('run/report.html');
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.match(await page.locator('#verdict').textContent(), /<\/script><script>window\.hacked = 1<\/script><img src=x/);
  assert.equal(await page.locator('.gates .passed').count(), 1);
  assert.match(await page.locator('.gates .failed').textContent(), /failed sd_pct ≤ 1e-09, k_y/);
  await close(page);
});

test('brushing highlights the same samples in every figure and shows their responses', async () => {
  const page = await open('run/report.html');
  const panel = page.locator('#inferred-2 svg');
  await panel.scrollIntoViewIfNeeded();
  const box = await panel.boundingBox();
  await page.mouse.move(box.x + 0.45 * box.width, box.y + 0.05 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.75 * box.width, box.y + 0.7 * box.height, {steps: 4});
  await page.mouse.up();
  await page.waitForSelector('#selection.active');
  const brush = await page.evaluate(() => window.twinmapReport.views.get('inferred-2').signal('brush'));
  const within = (value, [a, b]) => value >= Math.min(a, b) && value <= Math.max(a, b);
  const expected = readCsv(join(folder, 'run/predictions.csv')).filter(row => row.parameter === 'k_y' &&
      within(Number(row.true), brush.true_k_y) && within(Number(row.inferred), brush.inferred_k_y));
  assert.ok(expected.length > 3 && expected.length < kTestSamples - 3, `${expected.length} samples brushed`);
  await waitForSelection(page, expected.length);
  for (const id of ['inferred-0', 'errors-3', 'z-scores-1']) {
    await waitForMarks(page, expected.length, id, 'symbol', '[opacity="0.85"]');
  }
  await waitForMarks(page, expected.length, 'stddev-0', 'symbol', '[opacity="0.95"]');
  await waitForMarks(page, kNames.length * expected.length, 'reliability-0', 'symbol');
  await waitForMarks(page, Math.min(12, expected.length), 'selected-responses-0', 'line');
  await page.screenshot({path: join(kScreenshots, 'run-brushed.png')});

  await page.locator('#clear').click();
  await page.waitForSelector('#selection:not(.active)');
  await page.waitForSelector('#selected-responses', {state: 'hidden'});
  await waitForMarks(page, kTestSamples, 'errors-3', 'symbol', '[opacity="0.85"]');
  await close(page);
});

const kTall = {viewport: {width: 1280, height: 2100}};  // the first figure is in sight

/** Idle time comes when the test says so. */
function holdIdleTime() {
  window.idle = [];
  window.requestIdleCallback = callback => window.idle.push(callback);
}

async function giveIdleTime(page) {
  await page.waitForFunction(() => window.idle.length > 0);
  await page.evaluate(() => window.idle.shift()());
  await page.waitForFunction(() => window.idle.length > 0 || document.documentElement.dataset.drawn);
}

const readPanels = page => page.locator('figure:not([hidden]) .panel').evaluateAll(panels => panels.map(panel => {
  const {top, bottom} = panel.getBoundingClientRect();
  return {id: panel.id, drawn: panel.dataset.drawn === 'true', inSight: top < innerHeight && bottom > 0};
}));

test('what is in sight is drawn first, then what is nearest; what is drawn later is highlighted too', async () => {
  const page = await openUndrawn('run/report.html', kTall, holdIdleTime);
  await page.waitForFunction(() => performance.getEntriesByName('opened').length > 0);
  const opened = await readPanels(page);
  assert.ok(opened.some(panel => panel.inSight) && opened.some(panel => !panel.drawn));
  assert.deepEqual(opened.filter(panel => panel.inSight && !panel.drawn), []);

  await page.locator('#sample').fill('17');
  await page.keyboard.press('Enter');
  await waitForSelection(page, 1);
  await page.locator('#z-scores-0').evaluate(panel => panel.scrollIntoView());
  await giveIdleTime(page);
  await giveIdleTime(page);
  await waitForMarks(page, 1, 'z-scores-0', 'symbol', '[opacity="0.85"]');
  const later = await readPanels(page);
  assert.ok(later.find(panel => panel.id === 'z-scores-1').drawn);
  assert.ok(!later.at(-1).drawn);

  while (await page.evaluate(() => !document.documentElement.dataset.drawn)) await giveIdleTime(page);
  await assertEverythingDrawn(page);
  await close(page);
});

test('paper shows every figure, however early it is printed', async () => {
  const page = await openUndrawn('run/report.html', kTall, holdIdleTime);
  await page.waitForFunction(() => performance.getEntriesByName('opened').length > 0);
  assert.ok((await readPanels(page)).some(panel => !panel.drawn));
  const bytes = (await page.pdf()).length;
  await assertEverythingDrawn(page);
  await giveIdleTime(page);
  await page.waitForSelector('html[data-drawn=true]', {state: 'attached'});
  const again = (await page.pdf()).length;
  assert.ok(Math.abs(bytes - again) < 0.02 * again, `${bytes} bytes printed at once, ${again} when all was drawn`);
  await close(page);
});

test('pointing at a sample shows its parameters, with units', async () => {
  const page = await open('run/report.html');
  const row = readCsv(join(folder, 'run/predictions.csv')).find(({parameter}) => parameter === 'k_y');
  const point = page.locator(findMarks('inferred-2', 'symbol')).nth(Number(row.sample));
  await point.scrollIntoViewIfNeeded();
  await point.hover({force: true});
  const {x, y} = await point.boundingBox();
  await page.mouse.move(x + 1.5, y + 1.5);
  await page.waitForSelector('#vg-tooltip-element.visible');
  const text = await page.locator('#vg-tooltip-element').textContent();
  assert.match(text, /true k_y \[N\/m\]:?[0-9.]+/);
  await close(page);
});

test('a sample is highlighted by its number, and its response is that of samples.h5', async () => {
  const page = await open('run/report.html');
  await page.locator('#sample').fill('17');
  await page.keyboard.press('Enter');
  await page.waitForSelector('#selected-responses [data-drawn=true] .mark-line path');
  assert.match(await page.locator('#selection-text').textContent(), /^1 highlighted: 17$/);
  const rows = await page.evaluate(() => window.twinmapReport.toCsv('selected-responses'));
  assert.equal(rows.trim().split('\n').length, 1 + 2 * 100);
  await close(page);
});

test('the reader chooses parameters and axes', async () => {
  const page = await open('run/report.html');
  assert.match(await page.locator('#stddev-0').textContent(), /Stated sd of d_y \[N s\/m\]/);
  await page.locator('select[data-figure=stddev][data-choice=p]').selectOption({label: 'k_theta [N m/rad]'});
  await page.waitForFunction(() => /Stated sd of k_theta/.test(document.querySelector('#stddev-0').textContent));
  assert.equal(await countMarks(page, 'stddev-0', 'symbol'), kTestSamples);
  await close(page);
});

test('a run with failures says where and why', async () => {
  makeRunWithFailures(join(folder, 'failures'));
  const page = await open('failures/report.html');
  await assertEverythingDrawn(page);
  const failures = readFileSync(join(folder, 'failures/failures.csv'), 'utf8').trim().split('\n').length - 1;
  assert.ok(failures > 0);
  assert.equal(await page.locator('#failures-0 .layer_1_marks path').count(), failures);
  const counted = await page.locator('#reasons tbody td:first-child').allTextContents();
  assert.equal(counted.reduce((sum, count) => sum + Number(count), 0), failures);
  await close(page);
});

/** Columns of a page's table equal those of a file of the run, number for number; the page has 7 digits. */
async function assertSameNumbers(page, table, expected, columns) {
  const shown = await page.evaluate(name => window.twinmapReport.page.tables[name], table);
  for (const column of columns) {
    assert.deepEqual(shown[column].map(value => value === null ? NaN : Number(value)),
        expected.map(row => row[column] === '' ? NaN : Number(Number(row[column]).toPrecision(7))), `${table}, ${column}`);
  }
}

test('posteriors and baselines say what their files say', async () => {
  makeRunWithSprings(join(folder, 'springs'));
  const page = await open('springs/report.html');
  await assertEverythingDrawn(page);
  const posterior = readCsv(join(folder, 'springs/posterior.csv'));
  await assertSameNumbers(page, 'posterior', posterior, ['sample', 'posterior_mean', 'posterior_stddev', 'map_mean',
      'map_stddev', 'limit_stddev', 'effective_sample_size']);
  for (const [p, name] of ['k_1', 'k_2', 'd'].entries()) {
    const sampled = posterior.filter(row => row.parameter === name && Number.isFinite(Number(row.posterior_stddev)));
    assert.equal(await countMarks(page, `posterior-${p}`, 'symbol'), 2 * sampled.length); // the map's and the limit's
  }
  const baselines = readCsv(join(folder, 'springs/baselines.csv'));
  const rows = await page.locator('#baselines tbody tr').evaluateAll(found => found.map(row =>
      [...row.cells].map(cell => cell.dataset.value ?? cell.textContent)));
  assert.deepEqual(rows, baselines.map(row => Object.values(row)));
  assert.ok(['prior_mean', 'linear_regression', 'least_squares'].every(method => rows.some(row => row[0] === method)));
  await close(page);
});

test('the page says which combination of parameters is undetermined', async () => {
  const page = await open('springs/report.html');
  const weights = readCsv(join(folder, 'springs/identifiability.csv'));
  await assertSameNumbers(page, 'combinations', weights.flatMap(({eigenvalue, ...entries}) =>
      Object.values(entries).map(weight => ({weight}))), ['weight']);
  assert.equal(await countMarks(page, 'combinations-0', 'rect'), 9);
  const texts = await page.locator('#combinations-0 .mark-text.role-mark text').allTextContents();
  assert.deepEqual(texts.map(text => Number(text.replace('\u2212', '-'))),
      weights.flatMap(({eigenvalue, ...entries}) => Object.values(entries).map(weight => Number(Number(weight).toFixed(2)) + 0)));
  assert.match(await page.locator('#features').textContent(), /Undetermined: 0\.71 k_1 \u2212 0\.71 k_2, .* leave 100 %/);
  await close(page);
});

test('a sweep of 200 cases is aggregated, stays small, and says so', async () => {
  makeSweep(join(folder, 'sweep'), join(folder, 'run'));
  const bytes = statSync(join(folder, 'sweep/report.html')).size;
  assert.ok(bytes < 8e6, `${bytes} bytes`);
  const page = await open('sweep/report.html');
  await assertEverythingDrawn(page);
  assert.match(await page.locator('#verdict').textContent(), /200 cases/);
  assert.match(await page.locator('#verdict').textContent(), /summarised/);
  const groups = kSweep.sizes.length * kSweep.noises.length;
  for (const p of kNames.keys()) {
    assert.equal(await countMarks(page, `error-over-size-${p}`, 'symbol'), groups);
    assert.equal(await countMarks(page, `error-over-size-${p}`, 'line'), 2 * kSweep.noises.length); // and limits
    assert.equal(await countMarks(page, `error-over-noise-${p}`, 'line'), 2 * kSweep.sizes.length);
    assert.equal(await countMarks(page, `size-noise-${p}`, 'rect'), groups);
    assert.equal(await countMarks(page, `inferred-${p}`, 'symbol'), 500);
  }
  assert.equal(await page.locator('#sweep-table tbody tr').count(), groups * kNames.length);
  await close(page);
});

test('several runs stand side by side', async () => {
  callTwinmap('report', join(folder, 'run'), join(folder, 'failures'), '--out', join(folder, 'both'));
  const page = await open('both/report.html');
  await assertEverythingDrawn(page);
  assert.equal(await countMarks(page, 'errors-side-by-side-0', 'symbol'), 2);
  await close(page);
});

test('parameters over measurements are drawn with intervals and their course', async () => {
  makeHistory(folder, 'history.html');
  const page = await open('history.html', {viewport: {width: 1280, height: 900}});
  await assertEverythingDrawn(page);
  assert.equal(await countMarks(page, 'history-0', 'symbol'), 8);
  assert.equal(await countMarks(page, 'history-0', 'line'), 1);
  assert.match(await page.locator('p.lead').first().textContent(), /^k fell by .* at measurement 5\.$/);
  await screenshot(page, 'history-1280');
  await close(page);
});

test('a diagnosis draws residuals and the force that is missing, of the recording that is chosen', async () => {
  makeDiagnosis(folder, 'diagnosis.html');
  for (const width of [1280, 400]) {
    const page = await open('diagnosis.html', {viewport: {width, height: 900}});
    await assertEverythingDrawn(page);
    await assertFits(page, 'diagnosis');
    await screenshot(page, `diagnosis-${width}`);
    await close(page);
  }
  const page = await open('diagnosis.html');
  assert.equal(await page.locator('p.lead').textContent(), 'Missing: coulomb.x');
  assert.equal(await countMarks(page, 'residual-0-0', 'symbol'), 200); // before and after
  assert.equal(await countMarks(page, 'residual-0-1', 'line'), 2);
  assert.equal(await countMarks(page, 'force-0-0', 'line'), 2); // over the speed: as a function, and the term
  assert.equal(await countMarks(page, 'force-0-1', 'line'), 1); // over the position: the term
  assert.equal(await countMarks(page, 'force-0-time-0', 'area'), 1);
  const readBand = () => page.locator(findMarks('force-0-time-0', 'area')).getAttribute('d');
  const first = await readBand();
  await page.locator('select[data-figure=force-0-time][data-choice=recording]').selectOption({index: 1});
  await page.waitForFunction(([selector, before]) =>
      document.querySelector(selector) && document.querySelector(selector).getAttribute('d') !== before,
      [findMarks('force-0-time-0', 'area'), first]);
  await close(page);
});

test('very long names widen nothing', async () => {
  makeRunWithLongNames(join(folder, 'long'));
  for (const width of [1280, 400]) {
    const page = await open('long/report.html', {viewport: {width, height: 900}});
    await assertEverythingDrawn(page);
    await assertFits(page, 'long names');
    await screenshot(page, `long-${width}`);
    await close(page);
  }
});

for (const width of [1280, 400]) {
  for (const report of ['run', 'failures', 'springs', 'sweep', 'both']) {
    test(`${report} fits a window of ${width} pixels, light and dark`, async () => {
      const page = await open(`${report}/report.html`, {colorScheme: 'light', viewport: {width, height: 900}});
      await assertFits(page, report);
      await screenshot(page, `${report}-light-${width}`);
      await page.emulateMedia({colorScheme: 'dark'});
      const [paper, ink] = await page.evaluate(() => [getComputedStyle(document.body).backgroundColor,
          getComputedStyle(document.querySelector('.role-axis-title text')).fill]);
      assert.ok(brightness(paper) < 60 && brightness(ink) > 180, `${ink} on ${paper}`);
      await screenshot(page, `${report}-dark-${width}`);
      await close(page);
    });
  }
}
