// Outputs over time as SVG, with a cursor.
const WIDTH = 420, HEIGHT = 130, LEFT = 58, BOTTOM = 22, TOP = 8, RIGHT = 8;
const SPACE = "http://www.w3.org/2000/svg";

function make(name, attributes, parent, text) {
  const node = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  parent.append(node);
  return node;
}

function makePlot(parent, scene, index) {
  const { name, unit, measured } = scene.outputs[index];
  const rows = scene.motions.map((motion) => motion.outputs[index]).filter((row) => row && row.every(Number.isFinite));
  const all = [...rows.flat(), ...(measured ? measured.values : [])];
  const low = Math.min(...all), high = Math.max(...all), end = scene.times[scene.times.length - 1] || 1;
  const x = (time) => LEFT + (time / end) * (WIDTH - LEFT - RIGHT);
  const y = (value) => HEIGHT - BOTTOM - (high > low ? (value - low) / (high - low) : 0.5) * (HEIGHT - BOTTOM - TOP);
  const figure = document.createElement("figure");
  const caption = document.createElement("figcaption");
  caption.textContent = unit && unit !== "1" ? `${name} [${unit}]` : name;
  const svg = make("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `${name} over time` }, figure);
  figure.prepend(caption);
  for (const value of high > low ? [low, high] : [low]) {
    make("text", { x: LEFT - 4, y: y(value) + 4, "text-anchor": "end" }, svg, value.toPrecision(3));
  }
  make("text", { x: WIDTH - RIGHT, y: HEIGHT - 6, "text-anchor": "end" }, svg, `${end} s`);
  make("path", { class: "frame", d: `M${LEFT},${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` }, svg);
  if (measured) {
    const dots = measured.values.map((value, k) => `M${x(measured.times[k]).toFixed(1)},${y(value).toFixed(1)}h0`);
    make("path", { class: "dots", d: dots.join("") }, svg);
  }
  rows.forEach((row, i) => {
    const points = row.map((value, k) => `${x(scene.times[k]).toFixed(1)},${y(value).toFixed(1)}`);
    make("polyline", { class: `curve motion${i}`, points: points.join(" ") }, svg);
  });
  const cursor = document.createElement("div"); // over the drawing, which is then not drawn again
  cursor.className = "cursor";
  figure.append(cursor);
  parent.append(figure);
  let shown = false, now = 0;
  const place = () => { cursor.style.transform = `translateX(${(x(now) / WIDTH) * figure.clientWidth}px)`; };
  new IntersectionObserver(([entry]) => {
    shown = entry.isIntersecting;
    place();
  }).observe(figure);
  return (time) => {
    now = time;
    if (shown) place();
  };
}

export function makePlots(parent, scene) {
  if (scene.motions.length > 1) {
    const legend = document.createElement("p");
    scene.motions.forEach((motion, i) => {
      const entry = document.createElement("span");
      entry.className = `entry motion${i}`;
      entry.textContent = motion.name;
      legend.append(entry, " ");
    });
    if (scene.outputs.some((output) => output.measured)) legend.append("dots: measured");
    parent.append(legend);
  }
  const cursors = scene.times.length > 1 ? scene.outputs.map((output, i) => makePlot(parent, scene, i)) : [];
  return { setTime: (time) => cursors.forEach((move) => move(time)) };
}
