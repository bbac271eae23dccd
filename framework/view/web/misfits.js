// What the updated model does not explain, as colour on the bodies that the sensors belong to.
import { findFrame } from "./poses.js";

const FULL = { sd: 5, "% of range": 10 }; // of the residual at which a body has its colour alone

export function makeMisfits(scene, stage) {
  const outputs = scene.outputs.filter((output) => output.measured && output.body > 0);
  const machine = scene.motions.findIndex((motion) => motion.name.startsWith("updated"));
  if (!stage || machine < 0 || outputs.length === 0) return null;

  function calc(time) {
    const { frame, share } = findFrame(scene.times, time), at = share < 0.5 ? frame : frame + 1;
    const shares = scene.bodies.map(() => 0), texts = scene.bodies.map((body) => body.label);
    for (const { body, measured } of outputs) {
      const residual = measured.residual[Math.min(at, measured.residual.length - 1)];
      const share = residual === null ? 0 : Math.min(residual / FULL[measured.scale], 1);
      if (residual === null || share < shares[body]) continue;
      shares[body] = share;
      texts[body] = `${scene.bodies[body].name} ${residual.toFixed(1)} ${measured.scale}`;
    }
    return { shares, texts };
  }

  return {
    help: `The updated model turns red where it misses what was measured: wholly at ${outputs.map(({ measured }) => measured.scale)
      .filter((scale, i, all) => all.indexOf(scale) === i).map((scale) => `${FULL[scale]} ${scale}`).join(" or ")}.`,
    show: (time) => {
      const { shares, texts } = calc(time);
      stage.setMisfits(machine, shares);
      texts.forEach((text, body) => body > 0 && stage.setText(body, text));
    },
    hide: () => {
      stage.setMisfits(machine, null);
      scene.bodies.forEach((body, i) => i > 0 && stage.setText(i, body.label));
    },
  };
}
