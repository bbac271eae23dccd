// Geometry of what bodies look like, in their frames, one for each body.
import { BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CylinderGeometry, SphereGeometry } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { decode, toMatrix } from "./poses.js";

const STEPS = 65535; // of a mesh's grid

function makeMesh(shape) {
  const geometry = new BufferGeometry();
  const points = Float32Array.from(new Uint16Array(decode(shape.points)), (step, i) => (step / STEPS) * shape.size[i % 3]);
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(decode(shape.triangles)), 1));
  geometry.computeVertexNormals();
  return geometry;
}

const MAKERS = {
  box: ({ size }) => new BoxGeometry(...size),
  sphere: ({ size }) => new SphereGeometry(size[0] / 2, 20, 12),
  cylinder: ({ size }) => new CylinderGeometry(size[0] / 2, size[0] / 2, size[2], 20).rotateX(Math.PI / 2),
  capsule: ({ size }) => new CapsuleGeometry(size[0] / 2, size[2], 6, 16).rotateX(Math.PI / 2),
  mesh: makeMesh,
};

export function makeShapes(shapes) {
  const parts = shapes.map((shape) => {
    const part = MAKERS[shape.kind](shape);
    part.deleteAttribute("uv");
    return part.applyMatrix4(toMatrix(shape.frame));
  });
  return mergeGeometries(parts);
}
