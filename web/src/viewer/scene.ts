/** The scene: surfaces before and after a repair, rims of holes, a camera. It is drawn when something has changed. */
import {
  AmbientLight,
  Box3,
  DirectionalLight,
  PerspectiveCamera,
  Plane,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Action } from "../holes";
import { Measuring } from "./measuring";
import { type Goal, moveTo } from "./motion";
import { type Outlines, Rims } from "./rims";
import type { Surface } from "./surface";
import type { Tint } from "./tints";

const FIELD_OF_VIEW = 35;
const RIM_PIXELS = 8;
/** Few scans fill the sphere around their box: they are seen whole from nearer, as from a sphere of this many diagonals. */
const NARROW = 0.42;
/** Length of the mean normal from which on a scan is taken for open; that of a hemisphere is 0.5. */
const OPEN = 0.5;
export type Role = "before" | "after";
export type Axis = "x" | "y" | "z";

export class MeshScene {
  readonly measuring = new Measuring();
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly surfaces: Partial<Record<Role, Surface>> = {};
  private readonly origin = new Vector3();
  private readonly box = new Box3();
  private readonly raycaster = new Raycaster();
  private readonly resizing: ResizeObserver;
  private rims: Rims | null = null;
  private planes: Plane[] = [];
  private split = 0.5;
  private request = 0;
  private stopMotion = (): void => undefined;

  /** Raises an error where the browser has no WebGL. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly overlay: HTMLElement,
    private readonly onSelect: (id: number) => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    const light = new DirectionalLight("white", 2.2);
    light.position.set(0.4, 0.7, 1);
    this.camera.add(light);
    this.scene.add(this.camera, new AmbientLight("white", 0.9), this.measuring.group);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => this.stopMotion());
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(canvas);
    this.resize();
  }

  /** Show a surface; the first one decides where the camera stands. */
  setSurface(role: Role, surface: Surface, tint: Tint): void {
    const isFirst = !this.surfaces.before && !this.surfaces.after;
    if (isFirst) this.origin.fromArray(surface.about.origin);
    const former = this.surfaces[role];
    if (former) {
      this.scene.remove(former.group);
      former.dispose();
    }
    surface.placeAt(this.origin);
    surface.tint(tint);
    surface.cut(this.planes);
    this.surfaces[role] = surface;
    this.scene.add(surface.group);
    if (isFirst) {
      const { min, max } = surface.about.bounding_box;
      this.box.set(new Vector3().fromArray(min).sub(this.origin), new Vector3().fromArray(max).sub(this.origin));
      this.placeCamera(surface.meanNormal());
    }
    this.canvas.dataset[role] = surface.about.level;
    this.draw();
  }

  setOutlines(outlines: Outlines): void {
    if (this.rims) this.scene.remove(this.rims.lines);
    this.rims?.dispose();
    this.rims = new Rims(outlines, this.origin, this.overlay, this.onSelect);
    this.scene.add(this.rims.lines);
    this.canvas.dataset.outlines = String(outlines.holes.length);
    this.draw();
  }

  colourRims(actionOf: (id: number) => Action, selected: number | null): void {
    this.rims?.colour(actionOf, selected);
    this.draw();
  }

  showRims(isShown: boolean): void {
    this.rims?.setVisible(isShown);
    this.draw();
  }

  tint(tint: Tint): void {
    for (const surface of Object.values(this.surfaces)) surface.tint(tint);
    this.draw();
  }

  /** Left of this share of the picture the scan is shown as it was, right of it as it is repaired. */
  setSplit(split: number): void {
    this.split = split;
    this.draw();
  }

  /** Leave out what lies beyond a plane across an axis, at a share of the way through the scan; null: show all. */
  cut(axis: Axis | null, share: number): void {
    this.planes = [];
    if (axis) {
      const normal = new Vector3();
      normal[axis] = -1;
      this.planes = [new Plane(normal, this.box.min[axis] + share * (this.box.max[axis] - this.box.min[axis]))];
    }
    for (const surface of Object.values(this.surfaces)) surface.cut(this.planes);
    this.draw();
  }

  /** Look at a hole from outside, so that it fills half of the picture. */
  flyTo(id: number): void {
    const hole = this.rims?.outlines.holes.find((one) => one.id === id);
    if (!hole) return;
    const target = new Vector3().fromArray(hole.centre).sub(this.origin);
    const normal = hole.normal ? new Vector3().fromArray(hole.normal) : this.camera.position.clone().sub(target);
    if (normal.lengthSq() === 0) normal.set(0, 0, 1);
    this.fly({ target, position: this.seenFrom(target, normal, hole.diameter) }, String(id));
  }

  /** Look at the whole scan from the direction of now. */
  showAll(): void {
    const direction = this.camera.position.clone().sub(this.controls.target);
    const target = this.box.getCenter(new Vector3());
    this.fly({ target, position: this.seenFrom(target, direction, NARROW * this.diagonal()) }, "");
  }

  /** Turn the scan by angles in radians, and come nearer by a factor. */
  turn(aside: number, up: number, nearer = 1): void {
    this.stopMotion();
    const arm = this.camera.position.clone().sub(this.controls.target);
    const side = new Vector3().crossVectors(this.camera.up, arm).normalize();
    arm.applyAxisAngle(this.camera.up, aside);
    const tilted = arm.clone().applyAxisAngle(side.applyAxisAngle(this.camera.up, aside), up);
    const isOverThePole = Math.abs(tilted.angleTo(this.camera.up) - Math.PI / 2) > 1.5;
    this.camera.position.copy(this.controls.target).add((isOverThePole ? arm : tilted).divideScalar(nearer));
    this.controls.update();
  }

  /** The point of the shown surface under a place of the picture, (-1, -1) to (1, 1); null where there is none. */
  surfaceAt(x: number, y: number): Vector3 | null {
    this.raycaster.setFromCamera(new Vector2(x, y), this.camera);
    const shown = this.shownAt(x);
    const hits = shown ? this.raycaster.intersectObjects(shown.meshes, false) : [];
    const hit = hits.find(({ point }) => this.planes.every((plane) => plane.distanceToPoint(point) >= 0));
    return hit?.point ?? null;
  }

  /** The hole whose rim or middle is under a place of the picture. */
  holeAt(x: number, y: number): number | null {
    if (!this.rims?.lines.visible) return null;
    this.raycaster.setFromCamera(new Vector2(x, y), this.camera);
    return this.rims.holeNear(this.raycaster, this.surfaceAt(x, y));
  }

  draw(): void {
    if (this.request) return;
    this.request = requestAnimationFrame(() => {
      this.request = 0;
      this.drawNow();
    });
  }

  dispose(): void {
    this.stopMotion();
    cancelAnimationFrame(this.request);
    this.resizing.disconnect();
    this.controls.dispose();
    this.rims?.dispose();
    for (const surface of Object.values(this.surfaces)) surface.dispose();
    this.renderer.dispose();
  }

  private drawNow(): void {
    const { before, after } = this.surfaces;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    const edge = before && after ? Math.round(this.split * width) : width;
    this.renderer.setScissorTest(true);
    if (edge > 0) this.drawPart(before ?? after, 0, edge, height);
    if (edge < width) this.drawPart(after, edge, width - edge, height);
    this.rims?.placeNumbers(this.camera, width, height);
    this.canvas.dataset.frames = String(Number(this.canvas.dataset.frames ?? 0) + 1);
  }

  private drawPart(surface: Surface | undefined, left: number, width: number, height: number): void {
    for (const one of Object.values(this.surfaces)) one.group.visible = one === surface;
    this.renderer.setScissor(left, 0, width, height);
    this.renderer.render(this.scene, this.camera);
  }

  private shownAt(x: number): Surface | undefined {
    const { before, after } = this.surfaces;
    return before && after ? ((x + 1) / 2 < this.split ? before : after) : (before ?? after);
  }

  private fly(goal: Goal, hole: string): void {
    this.stopMotion();
    delete this.canvas.dataset.hole;
    this.stopMotion = moveTo(this.camera, this.controls.target, goal, (isThere) => {
      this.controls.update();
      this.draw();
      if (isThere) this.canvas.dataset.hole = hole;
    });
  }

  /** From where something of this width is seen whole. */
  private seenFrom(target: Vector3, direction: Vector3, radius: number): Vector3 {
    const narrow = Math.min(1, this.camera.aspect);
    const distance = Math.max(radius, this.diagonal() / 200) / Math.sin((FIELD_OF_VIEW * Math.PI) / 360) / narrow;
    return direction.clone().setLength(distance).add(target);
  }

  private diagonal(): number {
    return this.box.getSize(new Vector3()).length() || 1;
  }

  /** The first place of the camera, and how near and far it sees. */
  private placeCamera(meanNormal: Vector3): void {
    const [target, diagonal] = [this.box.getCenter(new Vector3()), this.diagonal()];
    // An open scan is seen from outside. Others look along z, as range cameras do.
    const front = meanNormal.length() > OPEN ? meanNormal.normalize() : new Vector3(0, 0, 1);
    this.camera.position.copy(this.seenFrom(target, aslant(front, this.camera.up), NARROW * diagonal));
    this.camera.near = diagonal / 2000;
    this.camera.far = diagonal * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.minDistance = diagonal / 500;
    this.controls.maxDistance = diagonal * 8;
    this.controls.update();
    this.raycaster.params.Line2 = { threshold: RIM_PIXELS };
  }

  private resize(): void {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}

/** A direction a little to the right of and above a normal, so that relief is seen. */
function aslant(normal: Vector3, up: Vector3): Vector3 {
  const right = new Vector3().crossVectors(up, normal);
  if (right.length() < 0.01) right.set(1, 0, 0);
  right.normalize();
  const above = new Vector3().crossVectors(normal, right);
  return normal.clone().addScaledVector(right, 0.25).addScaledVector(above, 0.2);
}
