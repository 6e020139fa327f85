/** Rims of holes as lines, and their numbers over them. */
import { Color, type PerspectiveCamera, type Raycaster, Vector3 } from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Action } from "../holes";

/** As the service hands them out: rims relative to the origin, centres in coordinates of the mesh. */
export interface Outlines {
  origin: [number, number, number];
  holes: Outline[];
}

export interface Outline {
  id: number;
  kind: string;
  diameter: number;
  centre: [number, number, number];
  normal: [number, number, number] | null;
  rim: [number, number, number][];
}

const COLOURS: Record<Action | "border" | "selected", Color> = {
  auto: new Color("#e4572e"),
  model: new Color("#2e86de"),
  smooth: new Color("#12a594"),
  flat: new Color("#8e5bd0"),
  skip: new Color("#777f85"),
  border: new Color("#777f85"),
  selected: new Color("#ffd400"),
};
/** Numbers of more holes would cover each other, and the page would be slow. */
const MOST_NUMBERS = 150;
/** Room that a number takes, in pixels. */
const WIDTH = 26;
const HEIGHT = 20;
/** Cosine between a hole's normal and the way to the eye, from which on it is taken for hidden. */
const FACING = -0.1;

export class Rims {
  readonly lines: LineSegments2;
  private readonly holeOfSegment: number[] = [];
  private readonly numbers = new Map<number, HTMLButtonElement>();
  private readonly numbered: Outline[];
  private readonly centres = new Map<number, Vector3>();
  private selected: number | null = null;
  private readonly isSelected = (hole: Outline): boolean => hole.id === this.selected;

  /** `origin`: the zero of the scene. `onSelect` is called with the hole whose number is clicked. */
  constructor(
    readonly outlines: Outlines,
    origin: Vector3,
    private readonly overlay: HTMLElement,
    onSelect: (id: number) => void,
  ) {
    const shift = new Vector3().fromArray(outlines.origin).sub(origin);
    const positions: number[] = [];
    for (const hole of outlines.holes) {
      this.centres.set(hole.id, labelPlace(hole, shift) ?? new Vector3().fromArray(hole.centre).sub(origin));
      hole.rim.forEach((point, i) => {
        const next = hole.rim[(i + 1) % hole.rim.length]!;
        for (const end of [point, next]) positions.push(end[0] + shift.x, end[1] + shift.y, end[2] + shift.z);
        this.holeOfSegment.push(hole.id);
      });
    }
    const geometry = new LineSegmentsGeometry().setPositions(positions);
    const material = new LineMaterial({ linewidth: 3, vertexColors: true, polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4 });
    this.lines = new LineSegments2(geometry, material);
    this.numbered = outlines.holes.slice(0, MOST_NUMBERS);
    for (const hole of this.numbered) this.addNumber(hole, onSelect);
  }

  private addNumber(hole: Outline, onSelect: (id: number) => void): void {
    const number = document.createElement("button");
    number.type = "button";
    number.className = "hole-number";
    number.textContent = String(hole.id);
    // The list has a button for each hole that the keyboard reaches and a screen reader reads.
    number.tabIndex = -1;
    number.addEventListener("click", () => onSelect(hole.id));
    this.overlay.append(number);
    this.numbers.set(hole.id, number);
  }

  /** Colour each rim by what is chosen for its hole. */
  colour(actionOf: (id: number) => Action, selected: number | null): void {
    this.selected = selected;
    const colours: number[] = [];
    const kinds = new Map(this.outlines.holes.map((hole) => [hole.id, hole.kind]));
    for (const id of this.holeOfSegment) {
      const action = actionOf(id);
      const isLeft = action === "auto" && (kinds.get(id) === "border" || kinds.get(id) === "open_end");
      const colour = COLOURS[id === selected ? "selected" : isLeft ? "border" : action];
      colours.push(colour.r, colour.g, colour.b, colour.r, colour.g, colour.b);
    }
    if (colours.length) this.lines.geometry.setColors(colours);
    for (const [id, number] of this.numbers) {
      number.classList.toggle("selected", id === selected);
      number.dataset.action = actionOf(id);
    }
  }

  /** Move the numbers over their holes. Those on the far side are hidden, and those that would cover a wider hole's. */
  placeNumbers(camera: PerspectiveCamera, width: number, height: number): void {
    const placed: [number, number][] = [];
    const [selected, others] = [this.numbered.filter(this.isSelected), this.numbered.filter((hole) => !this.isSelected(hole))];
    for (const hole of [...selected, ...others]) {
      const number = this.numbers.get(hole.id)!;
      const place = this.lines.visible ? this.pixelOf(hole, camera, width, height) : null;
      const isFree = place !== null && placed.every(([x, y]) => Math.abs(x - place[0]) > WIDTH || Math.abs(y - place[1]) > HEIGHT);
      number.hidden = !isFree;
      if (!isFree) continue;
      placed.push(place);
      number.style.transform = `translate(${place[0]}px, ${place[1]}px) translate(-50%, -50%)`;
    }
  }

  /** Where the number of a hole goes; null where its surface is turned away, or it is out of the picture. */
  private pixelOf(hole: Outline, camera: PerspectiveCamera, width: number, height: number): [number, number] | null {
    const centre = this.centres.get(hole.id)!;
    const view = camera.position.clone().sub(centre);
    const distance = view.length();
    if (hole.kind !== "border" && hole.normal && view.dot(new Vector3().fromArray(hole.normal)) < FACING * distance) return null;
    const { x, y, z } = centre.clone().project(camera);
    if (Math.abs(x) > 1 || Math.abs(y) > 1 || z >= 1) return null;
    const radius = (hole.diameter * height) / (4 * distance * Math.tan((camera.fov * Math.PI) / 360));
    // A number would cover a small hole: it goes above it.
    const above = hole.kind !== "border" && radius < 0.7 * WIDTH ? radius + 0.7 * HEIGHT : 0;
    return [((x + 1) / 2) * width, ((1 - y) / 2) * height - above];
  }

  setVisible(isVisible: boolean): void {
    this.lines.visible = isVisible;
  }

  /**
   * The hole whose rim the ray meets, else the narrowest one that it goes through the middle of.
   *
   * `surface` is where the ray meets the surface: what lies well behind it is hidden.
   */
  holeNear(raycaster: Raycaster, surface: Vector3 | null): number | null {
    const { ray } = raycaster;
    const depth = surface ? surface.distanceTo(ray.origin) : Infinity;
    const [rim] = raycaster.intersectObject(this.lines, false);
    if (rim && rim.distance < depth * 1.02) return this.holeOfSegment[rim.faceIndex ?? 0] ?? null;
    let [found, least]: [number | null, number] = [null, Infinity];
    for (const { id, kind, diameter } of this.outlines.holes) {
      const centre = this.centres.get(id)!;
      const isThrough = ray.distanceToPoint(centre) < 0.4 * diameter && centre.distanceTo(ray.origin) < depth + diameter / 2;
      if (kind !== "border" && isThrough && diameter < least) [found, least] = [id, diameter];
    }
    return found;
  }

  dispose(): void {
    for (const number of this.numbers.values()) number.remove();
    this.lines.geometry.dispose();
    this.lines.material.dispose();
  }
}

/** Where the number stands: in the middle of a hole, but on the rim of an outer border, whose middle is surface. */
function labelPlace(hole: Outline, shift: Vector3): Vector3 | null {
  const start = hole.rim[0];
  return hole.kind === "border" && start ? new Vector3().fromArray(start).add(shift) : null;
}
