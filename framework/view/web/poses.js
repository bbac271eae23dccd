// Poses of bodies at any time: between two frames origins move straight and axes turn about one axis.
import { Matrix4, Quaternion, Vector3 } from "three";

const NUMBERS = 12; // of a pose: columns of the rotation, then the origin

export function toMatrix(numbers, at = 0) {
  const n = (i) => numbers[at + i];
  return new Matrix4().set(n(0), n(3), n(6), n(9), n(1), n(4), n(7), n(10), n(2), n(5), n(8), n(11), 0, 0, 0, 1);
}

export function findFrame(times, time) {
  let frame = 0;
  while (frame + 2 < times.length && times[frame + 1] <= time) frame += 1;
  const width = times.length > 1 ? times[frame + 1] - times[frame] : 1;
  return { frame, share: times.length > 1 ? Math.min(Math.max((time - times[frame]) / width, 0), 1) : 0 };
}

export function setPose(object, poses, bodies, body, { frame, share }) {
  const scale = new Vector3();
  toMatrix(poses, (frame * bodies + body) * NUMBERS).decompose(object.position, object.quaternion, scale);
  if (share > 0) {
    const place = new Vector3(), turn = new Quaternion();
    toMatrix(poses, ((frame + 1) * bodies + body) * NUMBERS).decompose(place, turn, scale);
    object.position.lerp(place, share);
    object.quaternion.slerp(turn, share);
  }
}
