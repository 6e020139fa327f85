/** The straight distance between two points of a surface. */
import { BufferGeometry, Group, Line, LineBasicMaterial, Points, PointsMaterial, Vector3 } from "three";

export class Measuring {
  readonly group = new Group();
  private points: Vector3[] = [];
  private readonly geometry = new BufferGeometry();

  constructor() {
    const colour = "#d6006e";
    const overAll = { depthTest: false, transparent: true };
    this.group.add(
      new Points(this.geometry, new PointsMaterial({ color: colour, size: 11, sizeAttenuation: false, ...overAll })),
      new Line(this.geometry, new LineBasicMaterial({ color: colour, ...overAll })),
    );
    for (const part of this.group.children) part.renderOrder = 2;
    this.clear();
  }

  /** Take a point; a third one begins anew. */
  take(point: Vector3): void {
    this.points = this.points.length === 2 ? [point.clone()] : [...this.points, point.clone()];
    this.draw();
  }

  clear(): void {
    this.points = [];
    this.draw();
  }

  get nPoints(): number {
    return this.points.length;
  }

  /** The distance in mesh units, null before there are two points. */
  get distance(): number | null {
    const [first, second] = this.points;
    return first && second ? first.distanceTo(second) : null;
  }

  private draw(): void {
    this.group.visible = this.points.length > 0;
    if (this.points.length) this.geometry.setFromPoints(this.points.length === 1 ? [this.points[0]!, this.points[0]!] : this.points);
    this.geometry.computeBoundingSphere();
  }
}
