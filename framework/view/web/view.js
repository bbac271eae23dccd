// The page of a mechanism (page.cpp): reads the scene (scene_json.cpp), moves it and draws its outputs over time.
import { makeStage } from "./stage.js";
import { makeMisfits } from "./misfits.js";
import { makePlots } from "./plots.js";
import { decodePoses } from "./poses.js";

const scene = JSON.parse(document.getElementById("scene").textContent);
[...scene.motions, ...scene.modes].forEach(decodePoses);
const MOST_TOLD = 10; // bodies of which labels tell what acts on them; of more, names alone are crowded enough
scene.bodies.forEach((body) => {
  const told = body.acting.length > 0 && scene.bodies.length <= MOST_TOLD;
  body.label = told ? `${body.name}: ${body.acting.join(", ")}` : body.name;
});
const state = { time: scene.times[0], playing: false, speed: 1, labels: true, apart: false, misfits: true, mode: -1 };
const PERIOD = 2; // s that a period of a mode takes
const getEnd = () => (state.mode < 0 ? scene.times[scene.times.length - 1] : PERIOD);
const stage = scene.bodies.length > 0 ? makeStage(document.getElementById("stage"), scene) : null;
const plots = makePlots(document.getElementById("plots"), scene);
const misfits = makeMisfits(scene, stage);
const controls = document.getElementById("controls");

function add(element, attributes, text) {
  const node = Object.assign(document.createElement(element), attributes);
  if (text !== undefined) node.textContent = text;
  controls.append(node);
  return node;
}

const play = add("button", { type: "button", onclick: () => setPlaying(!state.playing) }, "Play");
const slider = add("input", { type: "range", min: 0, max: getEnd(), step: "any", value: 0, oninput: () => setTime(+slider.value) });
slider.setAttribute("aria-label", "time");
const clock = add("output", {});
const speed = add("select", { onchange: () => (state.speed = +speed.value) });
speed.setAttribute("aria-label", "speed");
for (const value of [0.1, 0.25, 0.5, 1, 2, 5]) {
  speed.append(new Option(`${value} x`, value, value === 1, value === 1));
}
const labels = stage ? add("button", { type: "button", onclick: () => setLabels(!state.labels) }, "Labels") : null;
const apart = stage && scene.motions.length > 1 ? add("button", { type: "button", onclick: () => setApart(!state.apart) }, "Side by side") : null;
const colour = misfits ? add("button", { type: "button", onclick: () => setMisfits(!state.misfits), title: misfits.help }, "Residual") : null;
if (stage && scene.modes.length > 0) addModes();
if (stage) add("button", { type: "button", onclick: () => stage.reset() }, "Reset view");
const below = document.getElementById("plots");
const makeText = (element, textContent) => Object.assign(document.createElement(element), { textContent });
if (misfits) below.prepend(makeText("p", misfits.help));
if (scene.remarks.length > 0) {
  const list = document.createElement("details");
  list.append(makeText("summary", `Drawn otherwise than the experiment says: ${scene.remarks.length}`));
  list.append(...scene.remarks.map((remark) => makeText("p", remark)));
  below.after(list);
}

function addModes() {
  const motion = add("select", { onchange: () => setMode(+motion.value) });
  motion.setAttribute("aria-label", "motion");
  motion.append(new Option("over time", -1, true, true));
  scene.modes.forEach((mode, i) => motion.append(
    new Option(`mode ${i + 1}: ${mode.frequency.toPrecision(4)} Hz, damping ${(100 * mode.damping).toPrecision(2)} %`, i)));
}

function setTime(time) {
  state.time = Math.min(Math.max(time, 0), getEnd());
  slider.value = state.time;
  if (state.mode >= 0) {
    clock.textContent = `${Math.round((360 * state.time) / PERIOD)}\u00b0`;
    stage.setMode(scene.modes[state.mode], state.time / PERIOD);
    return;
  }
  clock.textContent = `${state.time.toFixed(3)} s`;
  plots.setTime(state.time);
  if (stage) stage.setTime(state.time);
  if (misfits && state.misfits) misfits.show(state.time);
}

function setMode(mode) {
  state.mode = mode;
  slider.max = getEnd();
  stage.setAlone(mode >= 0);
  setTime(0);
  setPlaying(mode >= 0);
}

function setMisfits(shown) {
  state.misfits = shown;
  colour.setAttribute("aria-pressed", shown);
  shown ? misfits.show(state.time) : misfits.hide();
}

function setPlaying(playing) {
  state.playing = playing && getEnd() > 0;
  if (state.playing && state.time >= getEnd()) setTime(0);
  play.textContent = state.playing ? "Pause" : "Play";
}

function setLabels(shown) {
  state.labels = shown;
  if (!stage) return;
  labels.setAttribute("aria-pressed", shown);
  stage.setLabels(shown);
}

function setApart(isApart) {
  state.apart = isApart;
  apart.setAttribute("aria-pressed", isApart);
  if (stage) stage.setApart(isApart);
}

const keys = {
  " ": () => setPlaying(!state.playing),
  ArrowRight: () => setTime(state.time + getEnd() / 200),
  ArrowLeft: () => setTime(state.time - getEnd() / 200),
  Home: () => setTime(0),
  End: () => setTime(getEnd()),
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
    if (state.time >= getEnd()) state.mode < 0 ? setPlaying(false) : setTime(0);
  }
  last = now;
  if (stage) stage.render(false);
  requestAnimationFrame(tick);
}

document.documentElement.classList.toggle("moving", stage !== null || scene.bodies.length === 0);
setLabels(true);
if (misfits) setMisfits(true);
setTime(0);
requestAnimationFrame(tick);
window.twinmap = { scene, state, stage, setTime, setPlaying }; // for tests and for the curious
