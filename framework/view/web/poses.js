// Poses of bodies at any time: between two frames origins move straight and axes turn about one axis.
import { Matrix4, Quaternion, Vector3 } from "three";

const NUMBERS = 7; // of a pose: quaternion, origin

export const decode = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
export const decodePoses = (motion) => Object.assign(motion, { poses: new Float32Array(decode(motion.poses)) });
export const countFrames = (poses, bodies) => poses.length / (NUMBERS * bodies);

/** Of columns of the rotation, then the origin. */
export function toMatrix(numbers) {
  const n = (i) => numbers[i];
  return new Matrix4().set(n(0), n(3), n(6), n(9), n(1), n(4), n(7), n(10), n(2), n(5), n(8), n(11), 0, 0, 0, 1);
}

export function findFrame(times, time) {
  let frame = 0;
  while (frame + 2 < times.length && times[frame + 1] <= time) frame += 1;
  const width = times.length > 1 ? times[frame + 1] - times[frame] : 1;
  return { frame, share: times.length > 1 ? Math.min(Math.max((time - times[frame]) / width, 0), 1) : 0 };
}

const place = new Vector3(), turn = new Quaternion();

export function setPose(object, poses, bodies, body, { frame, share }) {
  const first = (frame * bodies + body) * NUMBERS, next = first + bodies * NUMBERS;
  object.quaternion.fromArray(poses, first);
  object.position.fromArray(poses, first + 4);
  if (share > 0) {
    object.quaternion.slerp(turn.fromArray(poses, next), share);
    object.position.lerp(place.fromArray(poses, next + 4), share);
  }
}
