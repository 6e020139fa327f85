/** A view of a mesh: its measured and its invented surface, read from a GLB and coloured. */
import {
  BufferAttribute,
  type BufferGeometry,
  Color,
  DoubleSide,
  Group,
  Mesh,
  MeshStandardMaterial,
  type Plane,
  Triangle,
  Vector3,
} from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { coloursOf, type Measure, MEASURES, type Tint } from "./tints";

const MEASURED = new Color("#b9c0c4");
const INVENTED = new Color("#e8912d");
const UNKNOWN = new Color("#8a6f9c");

/** What the service says of a view. */
interface About {
  origin: [number, number, number];
  length_unit: string;
  level: string;
  triangles: number;
  is_reduced: boolean;
  bounding_box: { min: number[]; max: number[] };
  has_colours: boolean;
  ranges?: Record<string, [number, number]>;
}

export class Surface {
  readonly group = new Group();
  readonly meshes: Mesh<BufferGeometry, MeshStandardMaterial>[] = [];

  private constructor(readonly about: About) {}

  /** Read a view. Raises an error where the bytes are no GLB. */
  static async read(bytes: ArrayBuffer): Promise<Surface> {
    const { scene } = await new GLTFLoader().parseAsync(bytes, "");
    const surface = new Surface(scene.userData as About);
    const found: Mesh[] = [];
    scene.traverse((node) => node instanceof Mesh && found.push(node));
    for (const node of found) surface.add(node.geometry as BufferGeometry, node.name);
    return surface;
  }

  private add(geometry: BufferGeometry, name: string): void {
    const material = new MeshStandardMaterial({ roughness: 0.75, metalness: 0, side: DoubleSide, vertexColors: true });
    // The inside of a surface is darker, so that it is told from its outside.
    material.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace(
        "#include <color_fragment>",
        "#include <color_fragment>\nif (!gl_FrontFacing) diffuseColor.rgb *= vec3(0.5, 0.45, 0.55);",
      );
    };
    if (!geometry.hasAttribute("normal")) geometry.computeVertexNormals();
    const mesh = new Mesh(geometry, material);
    mesh.name = name;
    geometry.userData.colours = geometry.getAttribute("color");
    this.meshes.push(mesh);
    this.group.add(mesh);
  }

  /** Numbers that this view has for its vertices. */
  measures(): Measure[] {
    const names = Object.keys(MEASURES) as Measure[];
    return names.filter((name) => this.meshes.some((mesh) => mesh.geometry.hasAttribute(MEASURES[name])));
  }

  /** The least and the largest value of a number, unknown ones aside. */
  range(measure: Measure): [number, number] {
    const stated = this.about.ranges?.[MEASURES[measure].toUpperCase()];
    if (stated) return stated;
    let [low, high] = [Infinity, -Infinity];
    for (const { geometry } of this.meshes) {
      for (const value of geometry.getAttribute(MEASURES[measure])?.array ?? []) {
        if (value < 0) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
    return low <= high ? [low, high] : [0, 1];
  }

  /** The mean normal of its triangles by area: as long as the share of the area that faces its way, near 0 if closed. */
  meanNormal(): Vector3 {
    const [triangle, normal, mean] = [new Triangle(), new Vector3(), new Vector3()];
    let area = 0;
    for (const { geometry } of this.meshes) {
      const corners = geometry.getAttribute("position");
      const index = geometry.getIndex();
      const at = (i: number) => (index ? index.getX(i) : i);
      for (let i = 0; i + 2 < (index ?? corners).count; i += 3) {
        triangle.setFromAttributeAndIndices(corners, at(i), at(i + 1), at(i + 2));
        mean.addScaledVector(triangle.getNormal(normal), triangle.getArea());
        area += triangle.getArea();
      }
    }
    return area > 0 ? mean.divideScalar(area) : mean;
  }

  /** Colour all vertices. */
  tint(tint: Tint): void {
    for (const mesh of this.meshes) {
      const { geometry, material } = mesh;
      const colours = this.colours(geometry, mesh.name === "invented" ? INVENTED : MEASURED, tint);
      if (colours) geometry.setAttribute("color", colours);
      material.color = colours ? new Color("white") : mesh.name === "invented" ? INVENTED : MEASURED;
      if (material.vertexColors !== Boolean(colours)) {
        material.vertexColors = Boolean(colours);
        material.needsUpdate = true;
      }
    }
  }

  private colours(geometry: BufferGeometry, base: Color, tint: Tint): BufferAttribute | null {
    if (tint === "colours") return (geometry.userData.colours as BufferAttribute | undefined) ?? null;
    if (tint === "plain") return null;
    const values = geometry.getAttribute(MEASURES[tint]);
    if (!values) return null;
    const unknown = base === INVENTED ? UNKNOWN : MEASURED;
    return new BufferAttribute(coloursOf(values.array, this.range(tint), unknown), 3);
  }

  cut(planes: Plane[]): void {
    for (const { material } of this.meshes) material.clippingPlanes = planes;
  }

  /** Lay the view where it belongs in a scene whose zero is `origin`. */
  placeAt(origin: Vector3): void {
    this.group.position.fromArray(this.about.origin).sub(origin);
  }

  dispose(): void {
    for (const { geometry, material } of this.meshes) {
      geometry.dispose();
      material.dispose();
    }
  }
}
