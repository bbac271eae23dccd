// The mechanism in WebGL; null where a browser has none.
import {
  AxesHelper, BufferGeometry, Color, CylinderGeometry, DirectionalLight, Group, HemisphereLight, Line, LineBasicMaterial,
  LineDashedMaterial, Mesh, MeshLambertMaterial, PerspectiveCamera, Scene, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { findFrame, setPose, toMatrix } from "./poses.js";

const COLORS = ["#4c78a8", "#e45756", "#54a24b"]; // of motions
const LINES = { spring: "#54a24b", damper: "#b279a2", rod: "#888888" };
const MARKS = { force: "#f58518", sensor: "#72b7b2", contact: "#9d755d" };

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

// How far the mechanism reaches from the middle of its places.
function measure(scene) {
  const low = new Vector3(Infinity, Infinity, Infinity), high = low.clone().negate();
  for (const motion of scene.motions) {
    for (let i = 0; i < motion.poses.length; i += 12) {
      const at = new Vector3(motion.poses[i + 9], motion.poses[i + 10], motion.poses[i + 11]);
      low.min(at);
      high.max(at);
    }
  }
  const reach = Math.max(...scene.bodies.flatMap((body) => body.radii), 0);
  const middle = low.clone().add(high).multiplyScalar(0.5);
  return { middle, size: Math.max(low.distanceTo(high) / 2 + reach, 1e-6) };
}

function makeBody(body, size, color, opacity) {
  const group = new Group();
  if (body.mass) {
    const smallest = 0.02 * size;
    const mesh = new Mesh(new SphereGeometry(1, 20, 12), new MeshLambertMaterial({ color, transparent: true, opacity }));
    mesh.applyMatrix4(toMatrix(body.ellipsoid));
    mesh.scale.set(...body.radii.map((radius) => Math.max(radius, smallest)));
    group.add(mesh);
  }
  return group;
}

// The joint of a body, on its parent: a cylinder along the axis, or a ball.
function makeJoint(body, size) {
  const group = new Group();
  group.applyMatrix4(toMatrix(body.in_parent));
  const material = new MeshLambertMaterial({ color: "#e45756", depthTest: false, transparent: true }); // seen through bodies
  const axis = new Vector3(...body.axis);
  if (axis.length() > 0) {
    const mesh = new Mesh(new CylinderGeometry(0.012 * size, 0.012 * size, 0.16 * size, 12), material);
    mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), axis.normalize());
    group.add(mesh);
  } else if (body.joint !== "weld" && body.joint !== "free") {
    group.add(new Mesh(new SphereGeometry(0.03 * size, 12, 8), material));
  }
  return group;
}

// A stick from the joint of a body to its centre of mass.
function makeStick(body, material) {
  const center = new Vector3(...body.ellipsoid.slice(9));
  return new Line(new BufferGeometry().setFromPoints([new Vector3(), center]), material);
}

class Machine {
  constructor(scene, motion, index, size) {
    this.scene = scene;
    this.motion = motion;
    this.root = new Group();
    const color = COLORS[index % COLORS.length], opacity = index === 0 ? 0.85 : 0.5;
    this.bodies = scene.bodies.map((body) => makeBody(body, size, color, opacity));
    this.bodies.forEach((group, i) => {
      this.root.add(group);
      if (i > 0) {
        this.bodies[scene.bodies[i].parent].add(makeJoint(scene.bodies[i], size));
        group.add(makeStick(scene.bodies[i], new LineBasicMaterial({ color })));
      }
    });
    for (const mark of scene.marks) {
      const dot = new Mesh(new SphereGeometry(0.025 * size, 12, 8), new MeshLambertMaterial({ color: MARKS[mark.kind], depthTest: false, transparent: true }));
      dot.position.set(...mark.point);
      this.bodies[mark.body].add(dot);
    }
    this.lines = scene.lines.map((line) => {
      const geometry = new BufferGeometry().setFromPoints([new Vector3(), new Vector3()]);
      const look = { color: LINES[line.kind], dashSize: 0.03 * size, gapSize: 0.02 * size };
      const drawn = new Line(geometry, line.kind === "rod" ? new LineBasicMaterial(look) : new LineDashedMaterial(look));
      this.root.add(drawn);
      return drawn;
    });
  }

  place(body, point) {
    const group = this.bodies[body];
    return new Vector3(...point).applyQuaternion(group.quaternion).add(group.position);
  }

  setTime(time) {
    const at = findFrame(this.scene.times, time);
    this.bodies.forEach((group, i) => setPose(group, this.motion, this.scene.bodies.length, i, at));
    this.scene.lines.forEach((line, i) => {
      this.lines[i].geometry.setFromPoints([this.place(line.from, line.from_point), this.place(line.to, line.to_point)]);
      this.lines[i].computeLineDistances();
    });
  }
}

function makeLabels(stage, scene) {
  return scene.bodies.map((body, i) => {
    const label = document.createElement("span");
    label.className = "label";
    label.textContent = i > 0 ? body.name : "";
    stage.append(label);
    return label;
  });
}

export function makeStage(stage, scene) {
  const renderer = makeRenderer(stage);
  if (renderer === null) return null;
  const { middle, size } = measure(scene);
  const world = new Scene();
  world.add(new HemisphereLight("#ffffff", "#888888", 2.2));
  const sun = new DirectionalLight("#ffffff", 1.5);
  sun.position.set(1, -2, 3);
  world.add(sun);
  const machines = scene.motions.map((motion, i) => new Machine(scene, motion, i, size));
  machines.forEach((machine) => world.add(machine.root));
  world.add(new AxesHelper(0.4 * size)); // of the ground: red x, green y, blue z
  const camera = new PerspectiveCamera(40, 1, 0.01 * size, 100 * size);
  const controls = new OrbitControls(camera, renderer.domElement);
  const labels = makeLabels(stage, scene);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const gravity = new Vector3(...scene.gravity);
  const up = gravity.length() > 0 ? gravity.clone().negate().normalize() : new Vector3(0, 0, 1);
  let shown = true;

  const paint = () => { world.background = new Color(dark.matches ? "#181818" : "#ffffff"); };
  dark.addEventListener("change", paint);
  paint();

  function reset() {
    const side = Math.abs(up.z) > 0.5 ? new Vector3(0.5, -0.8, 0.35) : new Vector3(0.35, 0.35, 0.9);
    camera.up.copy(up);
    camera.position.copy(middle).addScaledVector(side.normalize(), 2.8 * size);
    controls.target.copy(middle);
    controls.update();
  }

  let width = 1, height = 1;
  function resize() {
    width = stage.clientWidth;
    height = Math.max(240, Math.round(width * 0.5625));
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
  }
  new ResizeObserver(resize).observe(stage);
  resize();
  reset();

  function placeLabels() {
    labels.forEach((label, i) => {
      const at = machines[0].place(i, scene.bodies[i].ellipsoid.slice(9)).add(machines[0].root.position).project(camera);
      label.style.display = shown && i > 0 && Math.abs(at.z) < 1 ? "" : "none";
      label.style.transform = `translate(${((at.x + 1) / 2) * width}px, ${((1 - at.y) / 2) * height}px)`;
    });
  }

  return {
    machines,
    setTime: (time) => machines.forEach((machine) => machine.setTime(time)),
    setLabels: (value) => { shown = value; },
    setApart: (apart) => machines.forEach((machine, i) => machine.root.position.set(apart ? 2.2 * size * i : 0, 0, 0)),
    reset,
    render: () => {
      controls.update();
      renderer.render(world, camera);
      placeLabels();
    },
  };
}
