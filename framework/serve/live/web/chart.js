// Draws the history of one parameter as SVG.
const kWidth = 360, kHeight = 180, kLeft = 58, kBottom = 22, kTop = 8, kRight = 6;
const kMostPoints = 700;  // twice what the widest chart has pixels for
const kDates = 1e8;        // s: times beyond are since 1970, below numbers of measurements
const kSvg = 'http://www.w3.org/2000/svg';

/** Rows of CSV without line breaks in cells. */
function splitRow(line) {
  return [...line.matchAll(/("(?:[^"]|"")*"|[^,]*)(?:,|$)/g)].slice(0, -1)
      .map(match => match[1].startsWith('"') ? match[1].slice(1, -1).replaceAll('""', '"') : match[1]);
}

/** Of each parameter its rows {time, mean, lower, upper, smoothed}, oldest first; a Map. */
export function parseHistory(text) {
  const [header, ...rows] = text.split(/\r?\n/).filter(line => line !== '').map(splitRow);
  const histories = new Map();
  if (header === undefined) return histories;
  const place = Object.fromEntries(header.map((name, index) => [name, index]));
  for (const row of rows) {
    const get = name => row[place[name]] === undefined || row[place[name]] === '' ? NaN : Number(row[place[name]]);
    const name = row[place.parameter];
    if (!histories.has(name)) histories.set(name, []);
    histories.get(name).push({
      time: get('time'), mean: get('mean'), lower: get('lower'), upper: get('upper'), smoothed: get('smoothed_mean')
    });
  }
  return histories;
}

function thin(rows) {
  const step = Math.ceil(rows.length / kMostPoints);
  return rows.filter((row, index) => (rows.length - 1 - index) % step === 0);
}

function make(name, attributes, text) {
  const element = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

function makeScales(rows) {
  const lowest = Math.min(...rows.map(row => row.lower));
  const highest = Math.max(...rows.map(row => row.upper));
  const [first, last] = [rows[0].time, rows[rows.length - 1].time];
  const width = last - first || 1, height = highest - lowest || Math.abs(highest) || 1;
  return {
    lowest, highest, first, last,
    x: time => kLeft + (time - first) / width * (kWidth - kLeft - kRight),
    y: value => kTop + (1 - (value - lowest) / height) * (kHeight - kTop - kBottom)
  };
}

const describeTime = time => time > kDates ? new Date(1000 * time).toISOString().slice(0, 10) : String(time);

const makeLine = points => points.filter(([, y]) => Number.isFinite(y))
    .map(([x, y], index) => `${index === 0 ? 'M' : 'L'}${x.toFixed(1)} ${y.toFixed(1)}`).join('');

/** A figure: mean and 95 % band after each measurement, and the smoothed mean. */
export function drawChart(name, all) {
  const rows = thin(all.filter(row => Number.isFinite(row.lower) && Number.isFinite(row.upper)));
  const figure = document.createElement('figure');
  const heading = document.createElement('h3');
  heading.textContent = name;
  figure.append(heading);
  if (rows.length === 0) return figure;
  const {lowest, highest, first, last, x, y} = makeScales(rows);
  const newest = rows[rows.length - 1];
  const svg = make('svg', {
    viewBox: `0 0 ${kWidth} ${kHeight}`, role: 'img',
    'aria-label': `${name} over ${all.length} measurements: after the last from ` +
        `${newest.lower.toPrecision(6)} to ${newest.upper.toPrecision(6)} with 95 %`
  });
  const upper = rows.map(row => [x(row.time), y(row.upper)]);
  const lower = rows.map(row => [x(row.time), y(row.lower)]).reverse();
  svg.append(
      make('path', {class: 'band', d: `${makeLine([...upper, ...lower])}Z`}),
      make('path', {class: 'mean', d: makeLine(rows.map(row => [x(row.time), y(row.mean)]))}),
      make('path', {class: 'smoothed', d: makeLine(rows.map(row => [x(row.time), y(row.smoothed)]))}),
      make('path', {class: 'axis', d: `M${kLeft} ${kTop}V${kHeight - kBottom}H${kWidth - kRight}`, fill: 'none'}),
      make('text', {x: kLeft - 4, y: kTop + 8, 'text-anchor': 'end'}, highest.toPrecision(4)),
      make('text', {x: kLeft - 4, y: kHeight - kBottom, 'text-anchor': 'end'}, lowest.toPrecision(4)),
      make('text', {x: kLeft, y: kHeight - 6}, describeTime(first)),
      make('text', {x: kWidth - kRight, y: kHeight - 6, 'text-anchor': 'end'}, describeTime(last)));
  figure.append(svg);
  return figure;
}
