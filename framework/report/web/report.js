// The page's behaviour: draws its figures, sorts and copies its tables, highlights samples across figures.
'use strict';

(() => {
  const page = JSON.parse(document.getElementById('page-data').textContent);
  const views = new Map();   // panel id -> Vega view
  const drawing = new Map(); // panel id -> promise of its last drawing
  const rowsOfTable = new Map();
  let selected = null;       // null, or {sample: true, ...}

  // ---- Data -------------------------------------------------------------------------------------------------

  /** Column arrays -> one object per row. */
  function getRows(name) {
    if (!rowsOfTable.has(name)) {
      const columns = Object.entries(page.tables[name] || {});
      const count = columns.length ? columns[0][1].length : 0;
      rowsOfTable.set(name, Array.from({length: count},
          (_, i) => Object.fromEntries(columns.map(([column, values]) => [column, values[i]]))));
    }
    return rowsOfTable.get(name);
  }

  /** Names of the tables that a specification and its layers use. */
  function findTables(spec, names = new Set()) {
    if (spec && typeof spec === 'object') {
      if (spec.data && spec.data.name) names.add(spec.data.name);
      Object.values(spec).forEach(part => findTables(part, names));
    }
    return names;
  }

  // ---- Figures ----------------------------------------------------------------------------------------------

  const kConfig = {
    background: 'transparent',
    aria: false,  // a panel is one image with one text: what is within is not read out
    font: 'system-ui, -apple-system, "Segoe UI", Roboto, sans-serif',
    view: {stroke: null},
    axis: {
      domainColor: 'var(--line)', gridColor: 'var(--grid)', tickColor: 'var(--line)', labelColor: 'var(--quiet)',
      titleColor: 'var(--ink)', labelFontSize: 11, titleFontSize: 12, titleFontWeight: 'normal', titlePadding: 8,
      labelLimit: 110, titleLimit: 230, tickCount: 5, labelOverlap: true
    },
    axisY: {titleLimit: 190, minExtent: 34},
    legend: {
      labelColor: 'var(--ink)', titleColor: 'var(--ink)', labelFontSize: 11, titleFontSize: 11,
      titleFontWeight: 'normal', labelLimit: 95, titleLimit: 180, orient: 'top', symbolSize: 60
    },
    title: {
      color: 'var(--ink)', fontSize: 12, fontWeight: 600, anchor: 'start', frame: 'group', offset: 8, limit: 300
    },
    text: {color: 'var(--ink)'},
    range: {ramp: {scheme: 'viridis'}, heatmap: {scheme: 'viridis'}}
  };

  /** Legends break into as many columns as fit, titles end where the panel does. */
  function makeConfig(element) {
    const kColumnWidth = 115;
    const columns = Math.max(1, Math.floor(element.clientWidth / kColumnWidth));
    const kAxisWidth = 110;
    const limit = Math.max(60, element.clientWidth - kAxisWidth);
    return {...kConfig, title: {...kConfig.title, limit}, legend: {...kConfig.legend, columns}};
  }

  /** Replaces "{name}", "{name.label}" and "{name.domain}" by the chosen options. */
  function applyChoices(value, choices) {
    if (Array.isArray(value)) return value.map(item => applyChoices(item, choices));
    if (value && typeof value === 'object') {
      return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, applyChoices(item, choices)]));
    }
    if (typeof value !== 'string' || !value.includes('{')) return value;
    for (const choice of choices) {
      const option = choice.options[choice.chosen];
      if (value === `{${choice.name}.domain}`) return option.domain;
      value = value.split(`{${choice.name}.label}`).join(option.label).split(`{${choice.name}}`).join(option.value);
    }
    return value;
  }

  /** The samples of a table's rows within a brush: {field: [from, to], ...}. */
  function findBrushed(table, brush) {
    const ranges = Object.entries(brush).filter(([, range]) => Array.isArray(range));
    if (!ranges.length) return null;
    const within = row => ranges.every(([field, range]) =>
        row[field] >= Math.min(...range) && row[field] <= Math.max(...range));
    return Object.fromEntries(getRows(table).filter(within).map(row => [row.sample, true]));
  }

  function listen(view, spec, id) {
    const signals = view.getState({signals: name => name === 'brush' || name === 'selected'}).signals;
    if ('brush' in signals) {
      const table = spec.data.name;
      view.addSignalListener('brush', (_, brush) => select(findBrushed(table, brush), id));
    }
    if ('selected' in signals) {
      view.addEventListener('click', (_, item) => {
        const sample = item && item.datum && item.datum.sample;
        if (sample !== undefined) select({[sample]: true}, id);
      });
    }
  }

  /** Tooltips are made when the pointer comes, not for each of thousands of marks. */
  function deferTooltips(spec) {
    const defer = mark => {
      (mark.marks || []).forEach(defer);
      const {update, hover} = mark.encode || {};
      if (!update || !update.tooltip) return;
      mark.encode.hover = {...hover, tooltip: update.tooltip};
      delete update.tooltip;
    };
    spec.marks.forEach(defer);
    return spec;
  }

  async function drawPanel(figure, index) {
    const id = `${figure.name}-${index}`;
    const element = document.getElementById(id);
    const spec = applyChoices(figure.panels[index], figure.choices);
    spec.autosize = {type: 'fit-x', contains: 'padding'};
    spec.datasets = Object.fromEntries([...findTables(spec)].map(name => [name, getRows(name).map(row => ({...row}))]));
    if (views.has(id)) views.get(id).finalize();
    const result = await vegaEmbed(element, spec, {
      actions: false, renderer: 'svg', config: makeConfig(element), mode: 'vega-lite', tooltip: {theme: 'page'},
      patch: deferTooltips, hover: true
    });
    views.set(id, result.view);
    listen(result.view, spec, id);
    if (selected) highlight(result.view);
    element.dataset.drawn = 'true';
  }

  function fail(figure, error) {
    const note = document.createElement('p');
    note.className = 'problem';
    note.textContent = `This figure cannot be drawn: ${error.message}`;
    document.getElementById(figure.name).append(note);
    console.error(figure.name, error);
  }

  function redrawFigure(name) {
    const figure = page.figures.find(candidate => candidate.name === name);
    return Promise.all(figure.panels.map((_, index) => draw({figure, index})));
  }

  // ---- What is drawn when -----------------------------------------------------------------------------------

  /** Panels that nothing has drawn yet: {figure, index} by id, in reading order. */
  const pending = new Map();

  function listPending() {
    for (const figure of page.figures.filter(candidate => !document.getElementById(candidate.name).hidden)) {
      figure.panels.forEach((_, index) => pending.set(`${figure.name}-${index}`, {figure, index}));
    }
  }

  /** Draws a panel, after whatever is being drawn in its place. */
  function draw({figure, index}) {
    const id = `${figure.name}-${index}`;
    pending.delete(id);
    const drawn = Promise.resolve(drawing.get(id)).then(() => drawPanel(figure, index))
        .catch(error => fail(figure, error));
    drawing.set(id, drawn);
    return drawn;
  }

  /** How far a panel is from the window, in pixels; 0 in sight. */
  function calcDistance(id) {
    const {top, bottom} = document.getElementById(id).getBoundingClientRect();
    return Math.max(0, top - innerHeight, -bottom);
  }

  /** The ids of the panels nearest to the window first; a scroll makes another one the nearest. */
  let order = null;
  addEventListener('scroll', () => { order = null; }, {passive: true});

  function findNearest() {
    if (!order) {
      const distances = new Map([...pending.keys()].map(id => [id, calcDistance(id)]));
      order = [...distances.keys()].sort((a, b) => distances.get(a) - distances.get(b));
    }
    return pending.get(order.find(id => pending.has(id)));
  }

  /** Until the browser has nothing better to do. */
  function waitUntilIdle() {
    const kMax = 100;  // ms
    return new Promise(resolve => window.requestIdleCallback ? requestIdleCallback(resolve, {timeout: kMax})
                                                             : setTimeout(resolve));
  }

  /** Notes the time at which what has been drawn is also on the screen. */
  function markWhenPainted(name) {
    requestAnimationFrame(() => setTimeout(() => performance.mark(name)));
  }

  /** Draws what is in sight at once, the others in idle time, the one nearest to the window first. */
  async function drawAll() {
    listPending();
    for (const [id, panel] of [...pending]) {
      if (calcDistance(id) === 0) await draw(panel);
    }
    markWhenPainted('opened');
    while (pending.size > 0) {
      await waitUntilIdle();
      if (pending.size > 0) await draw(findNearest());
    }
    await Promise.all(drawing.values());
    document.documentElement.dataset.drawn = 'true';
    markWhenPainted('drawn');
  }

  /** Paper shows everything. */
  function drawForPrint() {
    [...pending.values()].forEach(draw);
  }

  // ---- Highlighted samples ----------------------------------------------------------------------------------

  function highlight(view) {
    try {
      view.signal('selected', selected).runAsync();
    } catch (error) {
      // A panel without samples has no such signal.
    }
  }

  let scheduled = false;

  function select(samples, source) {
    const count = samples ? Object.keys(samples).length : 0;
    selected = count ? samples : null;
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(() => {
      scheduled = false;
      views.forEach(highlight);
      describeSelection();
      showResponses();
      document.documentElement.dataset.selectedIn = selected ? source : '';
    });
  }

  function describeSelection() {
    if (!document.getElementById('selection')) return;
    const samples = selected ? Object.keys(selected) : [];
    const most = 8;
    document.getElementById('clear').disabled = !selected;
    document.getElementById('selection').classList.toggle('active', Boolean(selected));
    document.getElementById('selection-text').textContent = !selected
        ? 'or drag over points of a figure'
        : `${samples.length} highlighted: ${samples.slice(0, most).join(', ')}${samples.length > most ? ' ...' : ''}`;
  }

  /** Clean responses, as 16-bit fractions of each output's range: values of one sample, output by output. */
  function readResponses() {
    const bytes = Uint8Array.from(atob(page.responses.data), c => c.charCodeAt(0));
    return new Uint16Array(bytes.buffer);
  }

  let responses = null;

  function makeResponseRows(sample) {
    const {times, outputs, samples} = page.responses;
    const start = samples.indexOf(sample) * outputs.length * times.length;
    if (start < 0) return [];
    responses = responses || readResponses();
    const kSteps = 65535;
    return outputs.flatMap((output, o) => times.map((time, t) => ({
      sample, output: output.name, time,
      value: output.lower + (output.upper - output.lower) * responses[start + o * times.length + t] / kSteps
    })));
  }

  function showResponses() {
    const figure = document.getElementById('selected-responses');
    if (!figure || !page.responses) return;
    figure.hidden = !selected;
    if (!selected) return;
    const shown = Object.keys(selected).map(Number).slice(0, page.responses.most);
    const rows = shown.flatMap(makeResponseRows);
    rowsOfTable.set('selected-responses', rows);
    redrawFigure('selected-responses');
  }

  function setUpSelection() {
    const bar = document.getElementById('selection');
    if (!page.samples || !bar) return;
    bar.hidden = false;
    const input = document.getElementById('sample');
    input.addEventListener('change', () => {
      select(page.samples.includes(Number(input.value)) && input.value !== '' ? {[input.value]: true} : null, 'sample');
    });
    document.getElementById('clear').addEventListener('click', () => {
      input.value = '';
      select(null, '');
    });
    describeSelection();
  }

  // ---- Tables, buttons, choices -----------------------------------------------------------------------------

  function getCellValue(row, column) {
    const cell = row.cells[column];
    return cell.dataset.value !== undefined ? cell.dataset.value : cell.textContent;
  }

  function sortTable(table, heading) {
    const column = heading.cellIndex;
    const ascending = heading.getAttribute('aria-sort') !== 'ascending';
    const compare = (a, b) => {
      const [x, y] = [getCellValue(a, column), getCellValue(b, column)];
      return x !== '' && y !== '' && !isNaN(x) && !isNaN(y) ? x - y : x.localeCompare(y);
    };
    const body = table.tBodies[0];
    const rows = [...body.rows].sort((a, b) => ascending ? compare(a, b) : compare(b, a));
    body.append(...rows);
    table.querySelectorAll('th').forEach(th => th.setAttribute('aria-sort', 'none'));
    heading.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
  }

  function say(button, text) {
    const status = button.parentElement.querySelector('.said');
    if (status) status.textContent = text;
  }

  async function copyText(text) {
    if (navigator.clipboard && isSecureContext) return navigator.clipboard.writeText(text);
    const area = document.createElement('textarea');
    area.value = text;
    document.body.append(area);
    area.select();
    const copied = document.execCommand('copy');
    area.remove();
    if (!copied) throw new Error('the browser does not allow it');
  }

  function toCsv(name) {
    const quote = value => {
      const text = value === null || value === undefined ? '' : String(value);
      return /[",\r\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
    };
    const columns = Object.keys(page.tables[name] || getRows(name)[0] || {});
    return [columns, ...getRows(name).map(row => columns.map(column => row[column]))]
        .map(cells => cells.map(quote).join(',')).join('\n') + '\n';
  }

  function save(name, text) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([text], {type: 'text/csv'}));
    link.download = name;
    link.click();
    URL.revokeObjectURL(link.href);
  }

  function setUpControls() {
    document.querySelectorAll('table.sortable th button').forEach(button => button.addEventListener('click',
        () => sortTable(button.closest('table'), button.closest('th'))));
    document.querySelectorAll('[data-copy]').forEach(button => button.addEventListener('click', () => {
      copyText(page.texts[button.dataset.copy])
          .then(() => say(button, 'copied'), error => say(button, `not copied: ${error.message}`));
    }));
    document.querySelectorAll('[data-table]').forEach(button => button.addEventListener('click',
        () => save(`${button.dataset.table}.csv`, toCsv(button.dataset.table))));
    document.querySelectorAll('select[data-choice]').forEach(control => control.addEventListener('change', () => {
      const figure = page.figures.find(candidate => candidate.name === control.dataset.figure);
      figure.choices.find(choice => choice.name === control.dataset.choice).chosen = Number(control.value);
      redrawFigure(figure.name);
    }));
  }

  window.twinmapReport = {page, views, select, toCsv};
  setUpControls();
  setUpSelection();
  showResponses();
  addEventListener('beforeprint', () => document.querySelectorAll('details').forEach(folded => { folded.open = true; }));
  addEventListener('beforeprint', drawForPrint);
  drawAll();
})();
