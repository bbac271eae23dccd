// The mechanism in WebGL; null where a browser has none.
import { AxesHelper, Box3, Color, DirectionalLight, HemisphereLight, Object3D, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Machine } from "./machine.js";
import { countFrames, setPose, toMatrix } from "./poses.js";

const LOOKS = [ // of motions, in the colours of view.css: nominal; updated, which has the colours of residuals; measured
  { color: "#4c78a8", opacity: 1, front: 0 },
  { color: "#54a24b", opacity: 0.8, front: 1 },
  { color: "#f58518", opacity: 0.6, front: -1 },
];

// Without smoothed edges, which take half of the time where a processor draws; screens of small pixels do not show it.
function makeRenderer(stage) {
  try {
    const renderer = new WebGLRenderer({ antialias: false });
    stage.append(renderer.domElement);
    return renderer;
  } catch (error) {
    return null;
  }
}

// The middle of all that is ever drawn, and how far it reaches from there.
function measure(scene) {
  const box = new Box3();
  const spheres = scene.bodies.flatMap((body, i) => (i === 0 ? [] : [
    { i, center: new Vector3(), radius: 0 },
    { i, center: new Vector3(...body.ellipsoid.slice(9)), radius: body.shapes.length > 0 ? 0 : Math.max(...body.radii) },
    ...body.shapes.map(({ frame, size, kind }) => {
      const half = new Vector3(...size).divideScalar(2);
      const center = kind === "mesh" ? half.clone().applyMatrix4(toMatrix(frame)) : new Vector3(...frame.slice(9));
      return { i, center, radius: half.length() };
    }),
  ]));
  const at = new Vector3(), body = new Object3D(), count = scene.bodies.length;
  for (const { poses } of scene.motions) {
    for (let frame = 0; frame < countFrames(poses, count); frame += 1) {
      for (const { i, center, radius } of spheres) {
        setPose(body, poses, count, i, { frame, share: 0 });
        at.copy(center).applyQuaternion(body.quaternion).add(body.position);
        box.expandByPoint(at.clone().addScalar(radius)).expandByPoint(at.addScalar(-radius));
      }
    }
  }
  return { middle: box.getCenter(new Vector3()), size: Math.max(box.getSize(at).length() / 2, 1e-6) };
}

function makeLabels(stage, scene) {
  return scene.bodies.map((body, i) => {
    const label = document.createElement("span");
    label.className = "label";
    label.textContent = i > 0 ? body.label : "";
    stage.append(label);
    return label;
  });
}

function makeWorld(size) {
  const world = new Scene();
  world.add(new HemisphereLight("#ffffff", "#888888", 2.2));
  const sun = new DirectionalLight("#ffffff", 1.5);
  sun.position.set(1, -2, 3);
  world.add(sun, new AxesHelper(0.4 * size)); // of the ground: red x, green y, blue z
  return world;
}

export function makeStage(stage, scene) {
  const renderer = makeRenderer(stage);
  if (renderer === null) return null;
  const { middle, size } = measure(scene);
  const world = makeWorld(size);
  const machines = scene.motions.map((motion, i) => new Machine(scene, motion, LOOKS[i % LOOKS.length], size));
  machines.forEach((machine) => world.add(machine.root));
  const camera = new PerspectiveCamera(40, 1, 0.01 * size, 100 * size);
  const controls = new OrbitControls(camera, renderer.domElement);
  const labels = makeLabels(stage, scene);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const gravity = new Vector3(...scene.gravity);
  const up = gravity.length() > 0 ? gravity.clone().negate().normalize() : new Vector3(0, 0, 1);
  let shown = true, changed = true; // nothing is drawn again that has not changed

  const paint = () => {
    world.background = new Color(dark.matches ? "#181818" : "#ffffff");
    changed = true;
  };
  dark.addEventListener("change", paint);
  controls.addEventListener("change", () => { changed = true; });
  paint();

  function reset() {
    const side = Math.abs(up.z) > 0.5 ? new Vector3(0.5, -0.8, 0.35) : new Vector3(0.35, 0.35, 0.9);
    camera.up.copy(up);
    camera.position.copy(middle).addScaledVector(side.normalize(), 2.6 * size);
    controls.target.copy(middle);
    controls.update();
    changed = true;
  }

  let width = 1, height = 1;
  function resize() {
    width = stage.clientWidth;
    height = Math.max(240, Math.round(width * 0.5625));
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    changed = true;
  }
  new ResizeObserver(resize).observe(stage);
  resize();
  reset();

  function placeLabels() {
    labels.forEach((label, i) => {
      const at = machines[0].place(i, scene.bodies[i].ellipsoid.slice(9)).add(machines[0].root.position).project(camera);
      label.style.display = shown && i > 0 && Math.abs(at.z) < 1 ? "" : "none";
      label.style.transform = `translate(${((at.x + 1) / 2) * width + 8}px, ${((1 - at.y) / 2) * height + 8}px)`;
    });
  }

  // Lets `change` happen, and draws what it changed.
  const and = (change) => (...values) => {
    change(...values);
    changed = true;
  };

  return {
    machines,
    setTime: and((time) => machines.forEach((machine) => machine.setTime(time))),
    setMode: and((mode, phase) => {
      const steps = countFrames(mode.poses, scene.bodies.length) - 1, at = Math.min(phase * steps, steps - 1e-9);
      machines[0].setPoses(mode.poses, { frame: Math.floor(at), share: at % 1 });
    }),
    setAlone: and((alone) => machines.forEach((machine, i) => { machine.root.visible = i === 0 || !alone; })),
    setLabels: and((value) => { shown = value; }),
    setText: (body, text) => { labels[body].textContent = text; },
    setApart: and((apart) => machines.forEach((machine, i) => machine.root.position.set(apart ? 2.2 * size * i : 0, 0, 0))),
    setMisfits: and((machine, misfits) => machines[machine].setMisfits(misfits)),
    reset,
    render: (always = true) => {
      controls.update();
      if (!changed && !always) return;
      changed = false;
      renderer.render(world, camera);
      placeLabels();
    },
  };
}
