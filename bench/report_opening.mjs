// How long the report of a large sweep takes to open: 200 cases, 500 test samples.
// Usage: node bench/report_opening.mjs BUILD_FOLDER [REPETITIONS]
import {mkdtempSync, rmSync, statSync} from 'node:fs';
import {loadavg, tmpdir} from 'node:os';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const kSource = dirname(dirname(fileURLToPath(import.meta.url)));
const build = resolve(process.argv[2] ?? join(kSource, 'build/release'));
const repetitions = Number(process.argv[3] ?? 5);
process.env.TWINMAP ??= join(build, 'framework/cli/twinmap');
process.env.TWINMAP_SOURCE_DIR ??= kSource;
const kBrowserTests = 'tests/framework/report/browser';
process.env.TWINMAP_PLAYWRIGHT ??= join(build, kBrowserTests);
const {makeRun, makeSweep} = await import(join(kSource, kBrowserTests, 'fixtures.mjs'));
const {launchBrowser, openPage} = await import(join(kSource, kBrowserTests, 'launch.mjs'));

const folder = mkdtempSync(join(tmpdir(), 'twinmap_opening_'));
let browser;

/** Milliseconds from the start of the navigation until what is in sight, and until everything, is drawn and painted;
 *  the longest time, once open, in which the page could not answer; and the processor time of its thread. */
async function measure(report) {
  const page = await openPage(browser);
  await page.addInitScript(() => {
    window.tasks = [];
    new PerformanceObserver(list => window.tasks.push(...list.getEntries().map(({startTime, duration}) =>
        ({startTime, duration})))).observe({type: 'longtask', buffered: true});
  });
  await page.goto(`file://${report}`, {waitUntil: 'commit'});
  await page.waitForFunction(() => performance.getEntriesByName('drawn').length > 0);
  const found = await page.evaluate(() => {
    const [opened, drawn] = ['opened', 'drawn'].map(name => performance.getEntriesByName(name)[0].startTime);
    const tasks = window.tasks.filter(task => task.startTime >= opened && task.startTime < drawn);
    return {opened, drawn, blocked: Math.max(0, ...tasks.map(task => task.duration))};
  });
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable', {timeDomain: 'threadTicks'});
  const {metrics} = await session.send('Performance.getMetrics');
  found.task = 1000 * metrics.find(({name}) => name === 'TaskDuration').value;
  await page.context().close();
  return found;
}

const median = values => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];

try {
  makeRun(join(folder, 'run'));
  makeSweep(join(folder, 'sweep'), join(folder, 'run'));
  const report = join(folder, 'sweep/report.html');
  browser = await launchBrowser();
  await measure(report);  // the first one warms the disk's cache
  const found = [];
  for (let i = 0; i < repetitions; ++i) {
    found.push(await measure(report));
    console.log(Object.entries(found.at(-1)).map(([name, value]) => `${name} ${value.toFixed(0)} ms`).join(', '),
        `load ${loadavg()[0].toFixed(1)}`);
  }
  console.log(`${(statSync(report).size / 1e6).toFixed(2)} MB; medians of ${repetitions}:`,
      Object.keys(found[0]).map(name => `${name} ${median(found.map(one => one[name])).toFixed(0)} ms`).join(', '));
} finally {
  await browser?.close();
  rmSync(folder, {recursive: true, force: true});
}
