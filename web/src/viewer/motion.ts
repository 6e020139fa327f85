/** The camera on its way to a hole: along a straight line, and at once for who wants less motion. */
import type { PerspectiveCamera, Vector3 } from "three";

const MOTION_MS = 450;

export interface Goal {
  /** What is looked at, and from where. */
  target: Vector3;
  position: Vector3;
}

/** Move the camera; call `onStep` with whether it has arrived. Returns what stops it. */
export function moveTo(camera: PerspectiveCamera, target: Vector3, goal: Goal, onStep: (isThere: boolean) => void): () => void {
  const [fromTarget, fromPosition] = [target.clone(), camera.position.clone()];
  const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const started = performance.now();
  let request = 0;
  const step = (now: number): void => {
    const share = isStill ? 1 : Math.min(Math.max((now - started) / MOTION_MS, 0), 1);
    const eased = share * share * (3 - 2 * share);
    target.lerpVectors(fromTarget, goal.target, eased);
    camera.position.lerpVectors(fromPosition, goal.position, eased);
    onStep(share === 1);
    if (share < 1) request = requestAnimationFrame(step);
  };
  request = requestAnimationFrame(step);
  return () => cancelAnimationFrame(request);
}
