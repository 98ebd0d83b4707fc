/** The surfaces, their lines and points as three.js objects, and the camera that looks at them. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Raycaster,
  Scene,
  type ShaderMaterial,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

import { makeRamp, makeTerrainMaterial, type Tint, TINTS } from "./material";
import { Pace, simplify } from "./detail";
import { makeOrthoTexture } from "./ortho";
import type { LineLayer, Payload, SurfaceData } from "./payload";
import type { Hit, Surface, Terrain, Vector } from "./surface";
import { Network } from "./measure/network";
import { type Lines, unpackLines, unpackRows } from "./unpacking";

const FIELD_OF_VIEW = 30;
/** Share of width and height that the terrain takes at most, beside what is written around it. */
const FILLED = 0.86;
const FULL_CIRCLE = 2 * Math.PI;

/** A place of the camera, in coordinates from the origin. */
export interface Standpoint {
  target: [number, number, number];
  azimuth: number;
  tilt: number;
  away: number;
}

type Ramps = Record<string, ReturnType<typeof makeRamp>>;

/** What is shown as one: a surface, or the tiles of one. */
export interface Model {
  readonly surface: Terrain;
  readonly group: Group;
  readonly material: ShaderMaterial;
  readonly layers: Map<string, LineSegments2>;
  /** Breaklines, boundaries and water that are drawn, to measure along them. */
  readonly network: Network;
  readonly labels: { places: Float64Array; texts: string[]; marks: Points } | null;
  /** Whether its file gives colours. */
  readonly hasColors: boolean;
  /** Draw fewer triangles, or all of them. */
  setCoarse(isCoarse: boolean): void;
  showEdges(shown: boolean): void;
  paint(tint: Tint, ramps: Ramps, range: [number, number]): void;
  /** Say how exact a place is, or what is measured between places; "" if that goes without saying. */
  describeExactness(path: Hit[]): string;
}

/** One surface with all that is drawn with it. */
export class SurfaceModel implements Model {
  readonly group = new Group();
  readonly layers = new Map<string, LineSegments2>();
  readonly network: Network;
  readonly hasColors = false;
  labels: Model["labels"] = null;
  private edges: LineSegments | null = null;
  private readonly geometry: BufferGeometry;
  private readonly fine: BufferAttribute;
  private coarse: BufferAttribute | undefined;

  /** Where it is drawn from, so that 32 bits are enough. */
  private readonly middle: [number, number];

  /** Tiles of one surface have one material, and are drawn from places of their own. */
  constructor(
    readonly surface: Surface,
    readonly payload: Payload,
    private readonly steps: [number, number],
    readonly material = makeTerrainMaterial(payload.elevationScale, payload.colors, payload.origin[2]),
    middle: [number, number] = [0, 0],
    more: { colors: Float32Array | null; skirt: number } = { colors: null, skirt: 0 },
  ) {
    this.middle = middle;
    this.geometry = makeGeometry(surface, middle);
    if (more.colors !== null) this.geometry.setAttribute("given", new BufferAttribute(more.colors, 3));
    if (more.skirt > 0) addSkirt(this.geometry, more.skirt);
    this.fine = this.geometry.index!;
    const mesh = new Mesh(this.geometry, this.material);
    mesh.frustumCulled = false;
    this.group.add(mesh);
    this.group.position.set(...middle, 0);
    this.network = new Network(steps);
  }

  /** Give back what the graphics card holds. */
  dispose(): void {
    this.geometry.dispose();
    this.edges?.geometry.dispose();
  }

  setCoarse(isCoarse: boolean): void {
    if (isCoarse && this.coarse === undefined) {
      const kept = simplify(this.surface);
      this.coarse = kept === null ? this.fine : new BufferAttribute(kept, 1);
    }
    this.geometry.setIndex(isCoarse ? this.coarse! : this.fine);
  }

  async addLayers({ lines: layers, labels }: SurfaceData): Promise<void> {
    const [across, up] = this.steps;
    for (const layer of layers) {
      const lines = await unpackLines(layer.lines);
      const object = drawLines(layer, lines, across, up);
      this.network.add(layer.kind, lines);
      this.layers.set(layer.kind, object);
      this.group.add(object);
    }
    if (labels === null) return;
    const numbers = await unpackRows(labels.places);
    const places = Float64Array.from(numbers, (n, i) => n * (i % 3 === 2 ? up : across));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
    const material = new PointsMaterial({ size: 4, sizeAttenuation: false, color: this.payload.colors.objects });
    const marks = new Points(geometry, material);
    marks.visible = false;
    this.labels = { places, texts: labels.texts, marks };
    this.group.add(marks);
  }

  showEdges(shown: boolean): void {
    if (shown && this.edges === null) {
      this.edges = drawEdges(this.surface, this.middle, this.payload.colors.objects);
      this.group.add(this.edges);
    }
    if (this.edges !== null) this.edges.visible = shown;
  }

  paint(tint: Tint, ramps: Ramps, range: [number, number]): void {
    const isPlain = tint === "difference" && this.surface.difference === null;
    paintMaterial(this.material, isPlain ? "plain" : tint, ramps, range);
  }

  describeExactness(): string {
    return "";
  }
}

export function paintMaterial({ uniforms }: ShaderMaterial, tint: Tint, ramps: Ramps, range: [number, number]): void {
  uniforms.tint.value = TINTS.indexOf(tint);
  uniforms.ramp.value = tint === "plain" ? null : (ramps[tint] ?? ramps.elevation);
  uniforms.range.value = range;
}

/** Two surfaces beside each other: the border, a share of the width from the left, and both. */
export interface Split {
  share: number;
  left: Model;
  right: Model;
}

/** Renderer, camera and controls; drawn again only when something has changed. */
export class TerrainScene {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 1000);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  readonly models: Model[] = [];
  readonly ramps: Ramps = {};
  /** Called before each picture, once the camera stands, and after it. */
  readonly prepared: (() => void)[] = [];
  readonly drawn: (() => void)[] = [];
  split: Split | null = null;
  readonly pace = new Pace(() => this.setDetail());
  /** From where all of the surfaces are seen, until the view is moved: kept if its size changes. */
  private whole: [azimuth: number, tilt: number] | null = null;
  private isCoarse = false;
  private waiting = false;
  private exaggeration = 1;
  private readonly low = new Vector3();
  private readonly high = new Vector3();

  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly payload: Payload,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.screenSpacePanning = false;
    this.controls.zoomToCursor = true;
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    let isMoved = false;
    this.controls.addEventListener("start", () => (isMoved = true));
    this.controls.addEventListener("end", () => (isMoved = false));
    this.controls.addEventListener("change", () => {
      if (isMoved) this.whole = null;
      this.request();
    });
    for (const [name, colors] of Object.entries(payload.ramps)) this.ramps[name] = makeRamp(colors);
  }

  add(model: Model): void {
    this.models.push(model);
    this.scene.add(model.group);
    const { low, high } = model.surface;
    if (this.models.length === 1) {
      this.low.set(...low);
      this.high.set(...high);
    } else {
      this.low.min(new Vector3(...low));
      this.high.max(new Vector3(...high));
    }
  }

  /** Drape a picture over all surfaces. */
  drape(picture: ImageBitmap): void {
    const { place } = this.payload.ortho!;
    const texture = makeOrthoTexture(picture, this.renderer.capabilities.getMaxAnisotropy());
    for (const { material } of this.models) {
      material.uniforms.ortho.value = texture;
      material.uniforms.across.value.fromArray(place, 0);
      material.uniforms.down.value.fromArray(place, 3);
    }
  }

  /** Horizontal units on the screen for one unit of elevation. */
  get lift(): number {
    return this.payload.elevationScale * this.exaggeration;
  }

  get span(): number {
    return Math.max(this.high.x - this.low.x, this.high.y - this.low.y) || 1;
  }

  /** Lengths from west to east and from south to north. */
  get extent(): [number, number] {
    return [this.high.x - this.low.x, this.high.y - this.low.y];
  }

  /** Range of the tints, from the origin. */
  get elevations(): [number, number] {
    const [low, high] = this.payload.elevations, base = this.payload.origin[2];
    return [low - base, high - base];
  }

  exaggerate(factor: number): void {
    const target = this.controls.target;
    target.z *= factor / this.exaggeration;
    this.exaggeration = factor;
    for (const model of this.models) {
      model.group.scale.z = this.lift;
      model.group.updateMatrixWorld();
    }
    this.controls.update();
    this.request();
  }

  /** Where the camera is: what it looks at, from the origin, elevation in its own unit; from which
   *  direction and height above the horizon, degrees; and how far away. */
  get standpoint(): Standpoint {
    const target = this.controls.target;
    const arm = new Vector3().subVectors(this.camera.position, target);
    const away = arm.length();
    return {
      target: [target.x, target.y, target.z / this.lift],
      azimuth: ((Math.atan2(arm.x, arm.y) * 180) / Math.PI + 360) % 360,
      tilt: (Math.asin(arm.z / away) * 180) / Math.PI,
      away,
    };
  }

  set standpoint({ target, azimuth, tilt, away }: Standpoint) {
    this.whole = null;
    const [a, t] = [(azimuth * Math.PI) / 180, (Math.min(Math.max(tilt, 0.9), 89.9999) * Math.PI) / 180];
    const far = Math.min(Math.max(away, this.controls.minDistance), this.controls.maxDistance);
    this.controls.target.set(target[0], target[1], target[2] * this.lift);
    this.camera.position
      .set(Math.sin(a) * Math.cos(t), Math.cos(a) * Math.cos(t), Math.sin(t))
      .multiplyScalar(far)
      .add(this.controls.target);
    this.controls.update();
    this.request();
  }

  /** Whether all of the terrain is in view, as it was when it was last looked at. */
  get isWhole(): boolean {
    return this.whole !== null;
  }

  /** The surfaces that are shown, or those on one side of the border between two. */
  listShown(px?: number): Model[] {
    if (this.split === null) return this.models.filter((model) => model.group.visible);
    const { left, right } = this.split;
    if (px === undefined) return [left, right];
    return [px < this.border ? left : right];
  }

  /** Pixels from the left to the border between two surfaces: under the middle of the slider. */
  get border(): number {
    const thumb = 40;
    return this.split === null ? 0 : thumb / 2 + this.split.share * (this.canvas.clientWidth - thumb);
  }

  /** Look at the middle from a compass direction and a height above the horizon, in degrees. */
  look(azimuth: number, tilt: number): void {
    const [low, high] = this.boundVisible();
    const middle = new Vector3().addVectors(low, high).multiplyScalar(0.5);
    middle.z *= this.lift;
    const half = new Vector3().subVectors(high, low).multiplyScalar(0.5);
    half.z *= this.lift;
    const [a, t] = [(azimuth * Math.PI) / 180, (Math.min(tilt, 89.9999) * Math.PI) / 180];
    const away = this.findDistance(half, a, t);
    this.controls.target.copy(middle);
    this.camera.position.set(
      middle.x + away * Math.sin(a) * Math.cos(t),
      middle.y + away * Math.cos(a) * Math.cos(t),
      middle.z + away * Math.sin(t),
    );
    this.whole = [azimuth, tilt];
    this.controls.minDistance = away / 5000;
    this.controls.maxDistance = 6 * away;
    this.controls.update();
    this.request();
  }

  /** Return how far from its middle a box is seen whole, from a direction in radians. */
  private findDistance(half: Vector3, azimuth: number, tilt: number): number {
    const tangent = Math.tan(((FIELD_OF_VIEW / 2) * Math.PI) / 180) * FILLED;
    const near = [Math.sin(azimuth) * Math.cos(tilt), Math.cos(azimuth) * Math.cos(tilt), Math.sin(tilt)];
    const right = [-Math.cos(azimuth), Math.sin(azimuth), 0];
    const up = [-Math.sin(azimuth) * Math.sin(tilt), -Math.cos(azimuth) * Math.sin(tilt), Math.cos(tilt)];
    const reach = (axis: number[], corner: Vector3): number =>
      axis[0] * corner.x + axis[1] * corner.y + axis[2] * corner.z;
    let away = 0;
    for (const x of [-1, 1])
      for (const y of [-1, 1])
        for (const z of [-1, 1]) {
          const corner = new Vector3(x * half.x, y * half.y, z * half.z);
          const across = Math.abs(reach(right, corner)) / (tangent * this.camera.aspect);
          const along = Math.abs(reach(up, corner)) / tangent;
          away = Math.max(away, reach(near, corner) + Math.max(across, along));
        }
    return away || 1;
  }

  private boundVisible(): [Vector3, Vector3] {
    const seen = this.listShown();
    const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
    for (const { surface } of seen.length > 0 ? seen : this.models) {
      low.min(new Vector3(...surface.low));
      high.max(new Vector3(...surface.high));
    }
    // What is far off all others may leave the view, or nothing else would be seen.
    const [lowest, highest] = this.payload.relief, base = this.payload.origin[2];
    low.z = Math.max(low.z, Math.min(lowest - base, high.z));
    high.z = Math.min(high.z, Math.max(highest - base, low.z));
    return [low, high];
  }

  /** Turn around the middle of the view, and over it. */
  turn(around: number, over: number): void {
    this.whole = null;
    const arm = new Vector3().subVectors(this.camera.position, this.controls.target);
    const length = arm.length();
    const azimuth = (Math.atan2(arm.x, arm.y) + around + FULL_CIRCLE) % FULL_CIRCLE;
    const tilt = Math.min(Math.max(Math.asin(arm.z / length) + over, 0.02), Math.PI / 2 - 1e-4);
    arm.set(
      length * Math.sin(azimuth) * Math.cos(tilt),
      length * Math.cos(azimuth) * Math.cos(tilt),
      length * Math.sin(tilt),
    );
    this.camera.position.addVectors(this.controls.target, arm);
    this.controls.update();
    this.request();
  }

  /** Move over the ground by shares of the distance to it. */
  move(right: number, ahead: number): void {
    this.whole = null;
    const arm = new Vector3().subVectors(this.camera.position, this.controls.target);
    const heading = Math.atan2(-arm.x, -arm.y);
    const far = arm.length();
    const step = new Vector3(
      far * (right * Math.cos(heading) + ahead * Math.sin(heading)),
      far * (ahead * Math.cos(heading) - right * Math.sin(heading)),
      0,
    );
    this.camera.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
    this.request();
  }

  zoom(factor: number): void {
    this.whole = null;
    const arm = new Vector3().subVectors(this.camera.position, this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(arm, 1 / factor);
    this.controls.update();
    this.request();
  }

  /** Return the compass direction in which up on the screen lies, degrees clockwise from north. */
  get heading(): number {
    const arm = new Vector3().subVectors(this.controls.target, this.camera.position);
    return ((Math.atan2(arm.x, arm.y) * 180) / Math.PI + 360) % 360;
  }

  /** Return horizontal units in one pixel of the page in the middle of the view. */
  get unitsPerPixel(): number {
    const far = this.camera.position.distanceTo(this.controls.target);
    const height = 2 * far * Math.tan(((FIELD_OF_VIEW / 2) * Math.PI) / 180);
    return height / this.canvas.clientHeight;
  }

  /** Return pixels of the page of what is as high as it is away, ahead of the camera. */
  get pixelsPerSlope(): number {
    return this.canvas.clientHeight / (2 * Math.tan(((FIELD_OF_VIEW / 2) * Math.PI) / 180));
  }

  /** Return what lies under a pixel of the page, of the surfaces that are shown. */
  pick(px: number, py: number): { model: Model; hit: Hit } | null {
    const size = [this.canvas.clientWidth, this.canvas.clientHeight];
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * px) / size[0] - 1, 1 - (2 * py) / size[1]), this.camera);
    const from = caster.ray.origin.toArray() as Vector;
    const direction = caster.ray.direction.toArray() as Vector;
    let best: { model: Model; hit: Hit } | null = null;
    let nearest = Infinity;
    for (const model of this.listShown(px)) {
      const hit = model.surface.pick(from, direction, this.lift);
      if (hit === null) continue;
      const far = Math.hypot(hit.x - from[0], hit.y - from[1], hit.z * this.lift - from[2]);
      if (far < nearest) [nearest, best] = [far, { model, hit }];
    }
    return best;
  }

  /** Return where a place is on the page, and its depth: from 0 to 1, or as the distance ahead of
   *  the camera. Null behind the camera. */
  project(x: number, y: number, z: number, asDistance = false): [number, number, number] | null {
    const place = new Vector3(x, y, z * this.lift);
    const ahead = -place.clone().applyMatrix4(this.camera.matrixWorldInverse).z;
    place.project(this.camera);
    if (place.z > 1 || ahead <= 0) return null;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return [((place.x + 1) / 2) * width, ((1 - place.y) / 2) * height, asDistance ? ahead : place.z];
  }

  setBackground(color: string): void {
    this.scene.background = new Color(color);
    this.request();
  }

  resize(width: number, height: number): void {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    if (this.whole !== null) this.look(...this.whole);
    this.request();
  }

  request(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.pace.note(performance.now());
      this.setDetail();
      this.draw();
    });
  }

  /** Fit the number of triangles and pixels to the pace of the pictures. */
  private setDetail(): void {
    const { isCoarse } = this.pace;
    if (this.isCoarse === isCoarse) return;
    this.isCoarse = isCoarse;
    for (const model of this.models) model.setCoarse(isCoarse);
    const ratio = Math.min(window.devicePixelRatio, 2);
    this.renderer.setPixelRatio(isCoarse ? ratio / 2 : ratio);
    if (!isCoarse) this.request();
  }

  draw(): void {
    this.fitDepths();
    this.camera.updateMatrixWorld();
    for (const act of this.prepared) act();
    if (this.split === null) this.renderer.render(this.scene, this.camera);
    else this.drawBoth(this.split);
    for (const act of this.drawn) act();
  }

  private drawBoth({ left, right }: Split): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const shown = this.models.map((model) => model.group.visible);
    this.renderer.setScissorTest(true);
    const halves = [[left, 0, this.border], [right, this.border, width - this.border]] as const;
    for (const [half, from, wide] of halves) {
      for (const model of this.models) model.group.visible = model === half;
      this.renderer.setScissor(from, 0, wide, height);
      this.renderer.render(this.scene, this.camera);
    }
    this.renderer.setScissorTest(false);
    this.models.forEach((model, k) => (model.group.visible = shown[k]));
  }

  /** Let the depths that the picture holds end at the box around the surfaces. */
  private fitDepths(): void {
    const ahead = this.camera.getWorldDirection(new Vector3());
    let [nearest, farthest] = [Infinity, -Infinity];
    for (const x of [this.low.x, this.high.x])
      for (const y of [this.low.y, this.high.y])
        for (const z of [this.low.z, this.high.z]) {
          const depth = new Vector3(x, y, z * this.lift).sub(this.camera.position).dot(ahead);
          nearest = Math.min(nearest, depth);
          farthest = Math.max(farthest, depth);
        }
    const away = this.camera.position.distanceTo(this.controls.target);
    // In the midst of it what is far behind the target may flicker, as what is near must be seen.
    this.camera.near = nearest > 0 ? Math.max(0.9 * nearest, away / 20000) : away / 200;
    this.camera.far = Math.max(1.1 * farthest, 2 * this.camera.near);
    this.camera.updateProjectionMatrix();
  }
}

/** Return places in 32 bits from a middle. */
function shorten({ positions }: Surface, [x, y]: [number, number]): Float32Array {
  return Float32Array.from(positions, (value, i) => (i % 3 === 2 ? value : value - (i % 3 === 0 ? x : y)));
}

function makeGeometry(surface: Surface, middle: [number, number]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(shorten(surface, middle), 3));
  geometry.setIndex(new BufferAttribute(surface.triangles, 1));
  const change = surface.difference ?? new Float32Array(surface.positions.length / 3);
  geometry.setAttribute("change", new BufferAttribute(change, 1));
  geometry.setAttribute("normal", new BufferAttribute(averageNormals(surface), 3));
  return geometry;
}

/** Hang an apron on the rim, so that no gap is seen between tiles of different levels. */
function addSkirt(geometry: BufferGeometry, depth: number): void {
  const index = geometry.index!.array as Uint32Array;
  const count = geometry.getAttribute("position").count;
  const open = new Map<number, [number, number]>();
  for (let k = 0; k < index.length; k += 1) {
    const [a, b] = [index[k], index[k % 3 === 2 ? k - 2 : k + 1]];
    const key = Math.min(a, b) * count + Math.max(a, b);
    if (!open.delete(key)) open.set(key, [a, b]);
  }
  const below = new Map<number, number>();
  const hang = (vertex: number): number => {
    const found = below.get(vertex) ?? count + below.size;
    below.set(vertex, found);
    return found;
  };
  const more: number[] = [];
  for (const [a, b] of open.values()) more.push(a, hang(a), b, b, hang(a), hang(b));
  for (const name of Object.keys(geometry.attributes)) {
    const { array, itemSize } = geometry.getAttribute(name);
    const longer = new Float32Array(itemSize * (count + below.size));
    longer.set(array);
    for (const [vertex, at] of below) {
      for (let k = 0; k < itemSize; k += 1) longer[itemSize * at + k] = array[itemSize * vertex + k];
      if (name === "position") longer[itemSize * at + 2] -= depth;
    }
    geometry.setAttribute(name, new BufferAttribute(longer, itemSize));
  }
  const joined = new Uint32Array(index.length + more.length);
  joined.set(index);
  joined.set(more, index.length);
  geometry.setIndex(new BufferAttribute(joined, 1));
}

/** Return the normals of the true surface at the vertices, each triangle counted by its area seen
 *  from above: so steep slivers along a hull do not darken their neighbours. */
function averageNormals(surface: Surface): Float32Array {
  const { positions: p, triangles, elevationScale: s } = surface;
  const normals = new Float32Array(p.length);
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [3 * triangles[k], 3 * triangles[k + 1], 3 * triangles[k + 2]];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], (p[b + 2] - p[a + 2]) * s];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], (p[c + 2] - p[a + 2]) * s];
    const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const weight = nz / (Math.hypot(nx, ny, nz) || 1);
    for (const i of [a, b, c]) {
      normals[i] += weight * nx;
      normals[i + 1] += weight * ny;
      normals[i + 2] += weight * nz;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let axis = 0; axis < 3; axis += 1) normals[i + axis] /= length;
  }
  return normals;
}

/** Draw each edge once: of the two triangles at it, the one in which its ends ascend. */
function drawEdges(surface: Surface, middle: [number, number], color: string): LineSegments {
  const { triangles } = surface;
  const seen = new Set<number>();
  const count = surface.positions.length / 3;
  const ends: number[] = [];
  for (let k = 0; k < triangles.length; k += 1) {
    const a = triangles[k];
    const b = triangles[k % 3 === 2 ? k - 2 : k + 1];
    const key = Math.min(a, b) * count + Math.max(a, b);
    if (seen.delete(key)) continue;
    seen.add(key);
    ends.push(a, b);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(shorten(surface, middle), 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(ends), 1));
  const material = new LineBasicMaterial({ color, transparent: true, opacity: 0.35 });
  const object = new LineSegments(geometry, material);
  object.frustumCulled = false;
  return object;
}

function drawLines(layer: LineLayer, lines: Lines, across: number, up: number): LineSegments2 {
  const { vertices, offsets } = lines;
  const ends: number[] = [];
  const put = (i: number): void => {
    ends.push(vertices[3 * i] * across, vertices[3 * i + 1] * across, vertices[3 * i + 2] * up);
  };
  for (let k = 0; k + 1 < offsets.length; k += 1) {
    for (let i = offsets[k]; i + 1 < offsets[k + 1]; i += 1) {
      put(i);
      put(i + 1);
    }
  }
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(ends);
  const material = new LineMaterial({ color: layer.color, linewidth: layer.width });
  const object = new LineSegments2(geometry, material);
  if (layer.dashed) {
    object.computeLineDistances();
    const length = lengthOf(ends) / Math.max(1, ends.length / 6);
    Object.assign(material, { dashed: true, dashSize: length / 3, gapSize: length / 4 });
  }
  object.frustumCulled = false;
  return object;
}

function lengthOf(ends: number[]): number {
  let sum = 0;
  for (let i = 0; i + 5 < ends.length; i += 6)
    sum += Math.hypot(ends[i + 3] - ends[i], ends[i + 4] - ends[i + 1]);
  return sum;
}
