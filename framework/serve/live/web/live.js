// Fills the live page: the belief as it comes by /events, the history by /history now and then.
import {drawChart, parseHistory} from './chart.js';

const kShown = 20;              // measurements in the last table
const kHistoryInterval = 2000;  // ms, or longer: smoothing changes all of it with each measurement,
const kHistoryShare = 0.1;      // and may take this share of the server's time
const kDigits = 6;

const find = id => document.getElementById(id);
const toText = value => typeof value === 'number' ? String(Number(value.toPrecision(kDigits))) : '';

let paused = false;
let newest = null;   // the event to show
let shown = 0;       // measurements that the page has
let historyAt = -1;  // measurements that the charts have
let historyTimer = 0;
let historyTook = 0; // ms

function makeRow(cells) {
  const row = document.createElement('tr');
  for (const [text, kind] of cells) {
    const cell = document.createElement(kind === 'name' ? 'th' : 'td');
    if (kind === 'name') cell.scope = 'row';
    if (kind === 'number') cell.className = 'number';
    cell.textContent = text;
    row.append(cell);
  }
  return row;
}

function showNow(parameters) {
  find('now').tBodies[0].replaceChildren(...Object.entries(parameters).map(([name, belief]) => makeRow([
    [name, 'name'], [belief.unit ?? ''], [toText(belief.mean), 'number'], [toText(belief.sd), 'number'],
    [toText(belief.lower), 'number'], [toText(belief.upper), 'number']
  ])));
}

/** A sentence of what is a text, or an object of a few values. */
function describe(entry) {
  if (typeof entry !== 'object' || entry === null) return String(entry);
  if (typeof entry.text === 'string') return entry.text;
  return Object.entries(entry).map(([key, value]) =>
      `${key} ${value === null ? 'none' : typeof value === 'object' ? JSON.stringify(value) : typeof value === 'number' ? toText(value) : value}`)
      .join(', ');
}

function showList(id, entries, kind) {
  const list = Array.isArray(entries) ? entries.map(describe) :
      Object.entries(entries ?? {}).map(([name, entry]) => `${name}: ${describe(entry)}`);
  find(id).replaceChildren(...(list.length > 0 ? list : ['none']).map(text => {
    const item = document.createElement('li');
    item.className = list.length > 0 ? kind : 'quiet';
    item.textContent = text;
    return item;
  }));
}

function showLast(count, answer) {
  const body = find('last').tBodies[0];
  body.prepend(makeRow([[count, 'number'], [answer.source ?? ''], [answer.status ?? '']]));
  while (body.rows.length > kShown) body.deleteRow(-1);
}

function show() {
  if (paused || newest === null) return;
  const {state, answer} = newest;
  if (answer !== undefined && state.measurements !== shown) showLast(state.measurements, answer);
  shown = state.measurements;
  find('summary').textContent = `${shown} measurement${shown === 1 ? '' : 's'}` +
      (answer === undefined ? '' : `; the last: ${answer.status ?? 'not judged'}`);
  showNow(state.parameters ?? {});
  showList('alarms', state.alarms, 'bad');
  showList('forecast', state.forecast, '');
  scheduleHistory();
}

function scheduleHistory() {
  if (historyTimer === 0 && historyAt !== shown) {
    historyTimer = setTimeout(loadHistory, historyAt < 0 ? 0 : Math.max(kHistoryInterval, historyTook / kHistoryShare));
  }
}

async function loadHistory() {
  const count = shown, begin = performance.now();
  try {
    const response = await fetch('history');
    if (!response.ok) throw new Error((await response.json()).detail);
    const histories = parseHistory(await response.text());
    find('charts').replaceChildren(...[...histories].map(([name, history]) => drawChart(name, history)));
    find('history-text').textContent = histories.size === 0 ? 'No measurement yet.' : '';
    historyAt = count;
  } catch (error) {
    find('history-text').textContent = `The history could not be read: ${error.message}`;
  }
  historyTook = performance.now() - begin;
  historyTimer = 0;
  if (historyAt === count) scheduleHistory();
}

function connect() {
  const events = new EventSource('events');
  const say = (text, kind) => {
    find('connection').textContent = text;
    find('connection').className = kind;
  };
  events.addEventListener('open', () => say('live', 'good'));
  events.addEventListener('error', () => {
    say('disconnected, trying again', 'warn');
    if (events.readyState === EventSource.CLOSED) {  // refused: the browser gives up
      setTimeout(connect, kHistoryInterval);
    }
  });
  events.addEventListener('belief', event => {
    newest = JSON.parse(event.data);
    show();
  });
}

find('pause').addEventListener('click', () => {
  paused = !paused;
  find('pause').setAttribute('aria-pressed', String(paused));
  show();
});
connect();
