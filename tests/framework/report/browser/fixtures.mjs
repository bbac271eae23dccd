// Folders of runs and sweeps for the browser test.
import {execFileSync} from 'node:child_process';
import {cpSync, mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';

const kTwinmap = process.env.TWINMAP;
const kSource = process.env.TWINMAP_SOURCE_DIR;
const kTwoBeam = join(kSource, 'experiments/two_beam/best.yaml');

export const kHostile = `</script><script>window.hacked = 1</script><img src=x onerror="window.hacked = 1"> "q" & 'a' \${x}`;

export function callTwinmap(...args) {
  return execFileSync(kTwinmap, args, {encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe']});
}

export function readCsv(path) {
  const [header, ...rows] = readFileSync(path, 'utf8').trim().split('\n').map(line => line.split(','));
  return rows.map(cells => Object.fromEntries(header.map((column, i) => [column, cells[i]])));
}

export function writeCsv(path, rows) {
  const columns = Object.keys(rows[0]);
  const cell = value => /[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value);
  writeFileSync(path, [columns, ...rows.map(row => columns.map(column => row[column]))]
      .map(cells => cells.map(cell).join(',')).join('\n') + '\n');
}

/** The same numbers at every call. */
function makeRandom(seed = 1) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

export function makeNormal(random) {
  return () => Math.sqrt(-2 * Math.log(random())) * Math.cos(2 * Math.PI * random());
}

const kParameters = {d_y: [0.9, 1.1], d_theta: [1.75e-4, 2.25e-4], k_y: [5, 15], k_theta: [0.027, 0.045]};
export const kNames = Object.keys(kParameters);

/** Predictions of a calibrated map at its information limit. */
export function writePredictions(path, samples) {
  const random = makeRandom(7), normal = makeNormal(random);
  const rows = [];
  for (let sample = 0; sample < samples; ++sample) {
    for (const [parameter, [lower, upper]] of Object.entries(kParameters)) {
      const truth = lower + random() * (upper - lower);
      const stddev = 0.01 * truth * (0.5 + random());
      rows.push({sample, parameter, true: truth, inferred: truth + stddev * normal(), stddev, limit_stddev: 0.9 * stddev});
    }
  }
  writeCsv(path, rows);
}

function writeResponses(path) {
  const normal = makeNormal(makeRandom(3));
  const rows = [];
  for (const [which, sample] of [['best', 3], ['median', 5], ['worst', 8]]) {
    for (const [output, noise_stddev] of [['y', 5e-5], ['theta', 0.015]]) {
      for (let i = 1; i <= 50; ++i) {
        const time = 0.1 * i, updated = 20 * noise_stddev * Math.sin(3 * time), nominal = 1.1 * updated;
        rows.push({case: which, sample, output, time, measured: updated + noise_stddev * normal(), nominal, updated,
                   noise_stddev});
      }
    }
  }
  writeCsv(path, rows);
}

function writeFeatures(path) {
  const rows = [];
  for (const output of ['y', 'theta']) {
    for (let i = 1; i <= 100; ++i) {
      const time = Math.round(50 * i) / 1000;
      rows.push({feature: `${output}(${time} s)`, unit: 'm', output, time, noise_stddev: 1e-3,
                 ...Object.fromEntries(kNames.map((name, p) => [name, Math.sin((p + 1) * time)]))});
    }
  }
  writeCsv(path, rows);
}

function writeCorrelations(path) {
  writeCsv(path, kNames.map((parameter, i) => ({
    parameter, ...Object.fromEntries(kNames.map((name, j) => [name, i === j ? 1 : 0.1 * (i - j)]))
  })));
}

function writeHyperparameters(path) {
  writeCsv(path, kNames.flatMap(parameter => ['length_scale[0]', 'signal_stddev', 'noise_stddev'].map(
      (hyperparameter, i) => ({parameter, hyperparameter, value: 1 + i, lower: 0.01, upper: 1000}))));
}

export const kTestSamples = 60;

/** A real run, small, with hostile texts and with every file that a run may have. */
export function makeRun(folder) {
  callTwinmap('run', kTwoBeam, 'design.train.samples=60', `design.test.samples=${kTestSamples}`,
      'inverse_map.gp.starts=2', `description='${kHostile.replaceAll("'", "''")}'`,
      'gates=[{metric: coverage95, min: 0.1}, {metric: sd_pct, parameter: k_y, max: 1e-9}]', '--out', folder);
  writeResponses(join(folder, 'responses.csv'));
  writeFeatures(join(folder, 'features.csv'));
  writeCorrelations(join(folder, 'correlations.csv'));
  writeHyperparameters(join(folder, 'hyperparameters.csv'));
  callTwinmap('report', folder);
}

/** A run in which negative masses cannot be simulated. */
export function makeRunWithFailures(folder) {
  callTwinmap('run', join(kSource, 'experiments/two_beam/table1.yaml'), 'design.train.samples=40',
      'design.test.samples=30', 'parameters.m={bounds: [-0.5, 6], unit: kg, relative_to: range}', 'constants.m1=m',
      'simulation.allowed_failures=0.5', 'evaluation.limit=false', '--out', folder);
}

/** The page of eight measurements of a cart whose spring yields before the fifth. */
export function makeHistory(folder, page) {
  const cart = join(kSource, 'experiments/duffing/cart.yaml');
  const files = [...Array(8).keys()].map(i => {
    const file = join(folder, `history_${i}.csv`);
    callTwinmap('simulate', cart, '--noise', '--csv', file, `seed=${i}`, `parameters.k=${i < 4 ? 95 : 94.5}`);
    return file;
  });
  callTwinmap('infer', cart, ...files, '--page', join(folder, page));
}

/** A page of what the cart lacks by two recordings: dry friction. */
export function makeDiagnosis(folder, page) {
  const cart = join(kSource, 'experiments/duffing/cart.yaml');
  const files = [0, 1].map(i => {
    const file = join(folder, `diagnosis_${i}.csv`);
    callTwinmap('simulate', cart, '--noise', '--csv', file, `seed=${i}`,
        'system.force_laws[0].force=F - k3*x^3 - 0.03*tanh(x_dot/0.01)');
    return file;
  });
  callTwinmap('diagnose', cart, ...files, '--page', join(folder, page));
}

/** An experiment on a cart between springs, simulated in a moment. */
function makeCartYaml({name, parameters, stiffness, damping, output, more}) {
  return `name: ${name}
${more}
parameters:
${Object.entries(parameters).map(([parameter, rest]) => `  ${parameter}: ${rest}`).join('\n')}
system:
  bodies:
    cart: {mass: 1.2, joint: {type: slider, coordinates: [x]}}
  springs: [{coordinate: x, stiffness: ${stiffness}}]
  dampers: [{coordinate: x, damping: ${damping}}]
initial: {coordinates: {x: 0.1}}
outputs:
  ${output}: {coordinate: x}
simulation: {duration: 2}
features:
  - samples: {outputs: [${output}], start: 0.1, interval: 0.1, count: 20}
noise:
  stddev: {${output}: 1e-3}
design:
  train: {samples: 30}
  test: {samples: 20}
`;
}

/** A run whose parameters and outputs have names of 90 letters. */
export function makeRunWithLongNames(folder) {
  const [stiffness, damping, output] = ['stiffness_', 'dampingxx_', 'deflection'].map(name => name.repeat(9));
  const file = `${folder}.yaml`;
  writeFileSync(file, makeCartYaml({
    name: 'long_name_'.repeat(9), more: `description: ${'aWordWithoutASpace'.repeat(20)}`, stiffness, damping, output,
    parameters: {[stiffness]: '{bounds: [80, 120], unit: N/m}', [damping]: '{bounds: [0.5, 2], unit: N s/m}'}
  }));
  callTwinmap('run', file, '--out', folder);
}

/** A run with exact posteriors and baselines, in which the data determine the sum of two parameters only. */
export function makeRunWithSprings(folder) {
  const file = `${folder}.yaml`;
  writeFileSync(file, makeCartYaml({
    name: 'springs', stiffness: 'k_1 + k_2', damping: 'd', output: 'x',
    more: `evaluation:
  posterior: {samples: 4, draws: 200}
  baselines: [prior_mean, linear_regression, {least_squares: {samples: 3}}]`,
    parameters: {k_1: '{bounds: [40, 60], unit: N/m}', k_2: '{bounds: [40, 60], unit: N/m}',
                 d: '{bounds: [0.5, 2], unit: N s/m}'}
  }));
  callTwinmap('run', file, '--out', folder);
}

export const kSweep = {sizes: [50, 100, 250, 500, 1000], noises: [0.25, 1, 2, 4], seeds: 10};

/** A sweep of 5 sizes x 4 noise levels x 10 seeds = 200 cases; one of them a run of 500 test samples. */
export function makeSweep(folder, run) {
  const random = makeRandom(11);
  const rows = [];
  for (const size of kSweep.sizes) {
    for (const noise of kSweep.noises) {
      for (let seed = 1; seed <= kSweep.seeds; ++seed) {
        for (const parameter of kNames) {
          const limit = 0.5 * noise, sd = limit * (1 + 20 / size) * (0.9 + 0.2 * random());
          rows.push({case: `case${size}_${noise}_${seed}`, 'design.train.samples': size, 'noise.scale': noise, seed,
                     parameter, sd_pct: sd, coverage95: 0.95, limit_pct: limit, ratio_to_limit: sd / limit});
        }
      }
    }
  }
  mkdirSync(join(folder, 'cases'), {recursive: true});
  writeCsv(join(folder, 'sweep.csv'), rows);
  const shown = join(folder, 'cases', 'case1000_0.25_1');
  cpSync(run, shown, {recursive: true});
  writePredictions(join(shown, 'predictions.csv'), 500);
  callTwinmap('report', folder);
}
