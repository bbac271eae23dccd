// The page of a mechanism (page.cpp): reads the scene (scene_json.cpp), moves it and draws its outputs over time.
import { makeStage } from "./stage.js";
import { makePlots } from "./plots.js";

const scene = JSON.parse(document.getElementById("scene").textContent);
const state = { time: scene.times[0], playing: false, speed: 1, labels: true, apart: false };
const end = scene.times[scene.times.length - 1];
const stage = scene.bodies.length > 0 ? makeStage(document.getElementById("stage"), scene) : null;
const plots = makePlots(document.getElementById("plots"), scene);
const controls = document.getElementById("controls");

function add(element, attributes, text) {
  const node = Object.assign(document.createElement(element), attributes);
  if (text !== undefined) node.textContent = text;
  controls.append(node);
  return node;
}

const play = add("button", { type: "button", onclick: () => setPlaying(!state.playing) }, "Play");
const slider = add("input", { type: "range", min: 0, max: end, step: "any", value: 0, oninput: () => setTime(+slider.value) });
slider.setAttribute("aria-label", "time");
const clock = add("output", {});
const speed = add("select", { onchange: () => (state.speed = +speed.value) });
speed.setAttribute("aria-label", "speed");
for (const value of [0.1, 0.25, 0.5, 1, 2, 5]) {
  speed.append(new Option(`${value} x`, value, value === 1, value === 1));
}
const labels = add("button", { type: "button", onclick: () => setLabels(!state.labels) }, "Labels");
const apart = scene.motions.length > 1 ? add("button", { type: "button", onclick: () => setApart(!state.apart) }, "Side by side") : null;
add("button", { type: "button", onclick: () => stage && stage.reset() }, "Reset view");

function setTime(time) {
  state.time = Math.min(Math.max(time, 0), end);
  slider.value = state.time;
  clock.textContent = `${state.time.toFixed(3)} s`;
  plots.setTime(state.time);
  if (stage) stage.setTime(state.time);
}

function setPlaying(playing) {
  state.playing = playing && end > 0;
  if (state.playing && state.time >= end) setTime(0);
  play.textContent = state.playing ? "Pause" : "Play";
}

function setLabels(shown) {
  state.labels = shown;
  labels.setAttribute("aria-pressed", shown);
  if (stage) stage.setLabels(shown);
}

function setApart(isApart) {
  state.apart = isApart;
  apart.setAttribute("aria-pressed", isApart);
  if (stage) stage.setApart(isApart);
}

const keys = {
  " ": () => setPlaying(!state.playing),
  ArrowRight: () => setTime(state.time + end / 200),
  ArrowLeft: () => setTime(state.time - end / 200),
  Home: () => setTime(0),
  End: () => setTime(end),
  l: () => setLabels(!state.labels),
  r: () => stage && stage.reset(),
};
document.addEventListener("keydown", (event) => {
  const isControl = ["BUTTON", "INPUT", "SELECT"].includes(event.target.tagName);
  if (keys[event.key] && !isControl && !event.ctrlKey && !event.metaKey && !event.altKey) {
    keys[event.key]();
    event.preventDefault();
  }
});

let last = performance.now();
function tick(now) {
  if (state.playing) {
    setTime(state.time + ((now - last) / 1000) * state.speed);
    if (state.time >= end) setPlaying(false);
  }
  last = now;
  if (stage) stage.render();
  requestAnimationFrame(tick);
}

document.documentElement.classList.toggle("moving", stage !== null);
setLabels(true);
setTime(0);
requestAnimationFrame(tick);
window.twinmap = { scene, state, stage, setTime, setPlaying }; // for tests and for the curious
