// One motion of the mechanism. What is alike is drawn at once: ellipsoids, joints, marks, sticks and lines take a draw
// call each, however many bodies there are; bodies with shapes one each.
import {
  BufferAttribute, BufferGeometry, Color, CylinderGeometry, Group, InstancedMesh, LineBasicMaterial, LineDashedMaterial,
  LineSegments, Matrix4, Mesh, MeshLambertMaterial, Object3D, Quaternion, SphereGeometry, Vector3,
} from "three";
import { findFrame, setPose, toMatrix } from "./poses.js";
import { makeShapes } from "./shapes.js";

const LINES = { spring: "#54a24b", damper: "#b279a2", rod: "#888888" };
const MARKS = { force: "#f58518", sensor: "#72b7b2", contact: "#9d755d", constraint: "#eeca3b" };
const MISFIT = new Color("#d6004c");
const LAST = 10; // drawn after all bodies, through which it is seen
const UP = new Vector3(0, 1, 0);

/** Copies of a geometry that move with bodies: items have a body, a matrix in its frame and a colour. */
class Copies {
  constructor(geometry, material, items, root) {
    this.items = items;
    this.mesh = new InstancedMesh(geometry, material, items.length);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = LAST;
    items.forEach((item, i) => this.mesh.setColorAt(i, item.color));
    if (items.length > 0) root.add(this.mesh);
  }

  place(bodies) {
    const matrix = new Matrix4();
    this.items.forEach((item, i) => this.mesh.setMatrixAt(i, matrix.multiplyMatrices(bodies[item.body].matrix, item.matrix)));
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  paint(choose) {
    this.items.forEach((item, i) => this.mesh.setColorAt(i, choose(item.body, item.color)));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }
}

/** Segments between points of bodies. */
class Segments {
  constructor(ends, material, root) {
    this.ends = ends; // [body, point] two by two
    this.material = material;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * ends.length), 3));
    this.lines = new LineSegments(geometry, material);
    this.lines.frustumCulled = false;
    if (ends.length > 0) root.add(this.lines);
  }

  place(bodies) {
    const positions = this.lines.geometry.attributes.position, at = new Vector3();
    this.ends.forEach(([body, point], i) => {
      at.fromArray(point).applyMatrix4(bodies[body].matrix);
      positions.setXYZ(i, at.x, at.y, at.z);
    });
    positions.needsUpdate = true;
    if (this.material.isLineDashedMaterial) this.lines.computeLineDistances();
  }
}

const compose = (place, turn, scale) => new Matrix4().compose(place, turn, scale);

function listEllipsoids(scene, size, color) {
  return scene.bodies.flatMap((body, i) => {
    if (!body.mass || body.shapes.length > 0) return [];
    const scale = new Vector3(...body.radii.map((radius) => Math.max(radius, 0.04 * size)));
    return [{ body: i, matrix: toMatrix(body.ellipsoid).scale(scale), color }];
  });
}

/** On the parent: a rod along the axis, or a ball where there is none. */
function listJoints(scene, size, hasAxis) {
  const color = new Color("#e45756");
  return scene.bodies.flatMap((body, i) => {
    const axis = new Vector3(...body.axis), one = new Vector3(1, 1, 1);
    const drawn = i > 0 && (hasAxis ? axis.length() > 0 : axis.length() === 0 && !["weld", "free"].includes(body.joint));
    const turn = hasAxis ? new Quaternion().setFromUnitVectors(UP, axis.normalize()) : new Quaternion();
    return drawn ? [{ body: body.parent, matrix: toMatrix(body.in_parent).multiply(compose(new Vector3(), turn, one)), color }] : [];
  });
}

export class Machine {
  /** front: which of machines at the same place is seen. */
  constructor(scene, motion, { color, opacity, front }, size) {
    Object.assign(this, { scene, motion, color: new Color(color), root: new Group() });
    const beside = { polygonOffset: true, polygonOffsetFactor: -2 * front, polygonOffsetUnits: -2 * front };
    const solid = () => new MeshLambertMaterial({ transparent: opacity < 1, opacity, ...beside });
    const seenThrough = () => new MeshLambertMaterial({ depthTest: false, transparent: true });
    this.bodies = scene.bodies.map(() => new Object3D());
    this.bodies.forEach((body) => this.root.add(body));
    this.shapes = scene.bodies.map((body, i) => {
      if (body.shapes.length === 0) return null;
      const mesh = new Mesh(makeShapes(body.shapes), solid());
      mesh.material.color.copy(this.color);
      mesh.renderOrder = front;
      this.bodies[i].add(mesh);
      return mesh;
    });
    const marks = scene.marks.map((mark) => ({
      body: mark.body, color: new Color(MARKS[mark.kind]), matrix: new Matrix4().makeTranslation(...mark.point),
    }));
    const ellipsoids = listEllipsoids(scene, size, this.color);
    const fineness = ellipsoids.length > 20 ? 5 : ellipsoids.length > 4 ? 10 : 20; // of many, which are small, the coarse take a third of the time
    const glass = new MeshLambertMaterial({ transparent: true, opacity: 0.75 * opacity, ...beside }); // they may hide each other
    this.ellipsoids = new Copies(new SphereGeometry(1, 2 * fineness, fineness + 2), glass, ellipsoids, this.root);
    this.ellipsoids.mesh.renderOrder = front;
    const rod = new CylinderGeometry(0.012 * size, 0.012 * size, 0.16 * size, 8), ball = new SphereGeometry(0.025 * size, 10, 6);
    this.parts = [
      this.ellipsoids,
      new Copies(rod, seenThrough(), listJoints(scene, size, true), this.root),
      new Copies(ball, seenThrough(), listJoints(scene, size, false), this.root),
      new Copies(ball, seenThrough(), marks, this.root),
      new Segments(this.listSticks(), new LineBasicMaterial({ color }), this.root),
      ...Object.keys(LINES).map((kind) => this.makeLines(kind, size)),
    ];
  }

  /** From joints to centres of mass. */
  listSticks() {
    return this.scene.bodies.flatMap((body, i) => (i > 0 ? [[i, [0, 0, 0]], [i, body.ellipsoid.slice(9)]] : []));
  }

  makeLines(kind, size) {
    const look = { color: LINES[kind], dashSize: 0.03 * size, gapSize: 0.02 * size };
    const ends = this.scene.lines.filter((line) => line.kind === kind)
      .flatMap((line) => [[line.from, line.from_point], [line.to, line.to_point]]);
    return new Segments(ends, kind === "rod" ? new LineBasicMaterial({ color: LINES[kind] }) : new LineDashedMaterial(look), this.root);
  }

  place(body, point) {
    return new Vector3(...point).applyMatrix4(this.bodies[body].matrix);
  }

  setPoses(poses, at) {
    this.bodies.forEach((body, i) => {
      setPose(body, poses, this.bodies.length, i, at);
      body.updateMatrix();
    });
    this.parts.forEach((part) => part.place(this.bodies));
  }

  setTime(time) {
    this.setPoses(this.motion.poses, findFrame(this.scene.times, time));
  }

  /** Shares, from 0 to 1, of how far bodies take the colour of what is not explained; null: none. */
  setMisfits(misfits) {
    const choose = (body, color) => color.clone().lerp(MISFIT, misfits ? misfits[body] : 0);
    this.ellipsoids.paint(choose);
    this.shapes.forEach((mesh, i) => mesh && mesh.material.color.copy(choose(i, this.color)));
  }
}
