// The skeletons of figures are Vega-Lite specifications that draw their own examples, as they stand.
import assert from 'node:assert/strict';
import {readFileSync, readdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {test} from 'node:test';

const require = createRequire(join(process.env.TWINMAP_WEB, 'package.json'));
const vega = require('vega');
const vegaLite = require('vega-lite');

const kFolder = join(process.env.TWINMAP_SOURCE_DIR, 'framework/report/web/figures');

/** Notes what Vega-Lite and Vega complain about, but for the window that Node has not. */
function makeLogger(complaints) {
  const note = (...message) => {
    if (!message.join(' ').endsWith('event source: window')) complaints.push(message.join(' '));
    return logger;
  };
  const logger = {level: () => logger, warn: note, error: note, info: () => logger, debug: () => logger};
  return logger;
}

const countMarks = item => (item.items || []).reduce((sum, child) => sum + countMarks(child),
                                                     item.role === 'mark' ? item.items.length : 0);

const files = readdirSync(kFolder, {recursive: true}).filter(file => file.endsWith('.json'));
assert.ok(files.length > 0);
for (const file of files) {
  test(`${file} draws its examples`, async () => {
    const skeleton = JSON.parse(readFileSync(join(kFolder, file)));
    const complaints = [];
    const logger = makeLogger(complaints);
    const {spec} = vegaLite.compile({...skeleton, width: 400}, {logger});
    const view = new vega.View(vega.parse(spec), {renderer: 'none', logger});
    await view.runAsync();
    assert.deepEqual(complaints, []);
    const shown = skeleton.layer || [skeleton];
    assert.ok(countMarks(view.scenegraph().root) >= shown.length, 'some of its marks are missing');
    view.finalize();
  });
}
