/** A tileset as one surface: tiles come as the view needs them, and go when memory is short. */

import { Frustum, Group, Matrix4, Box3, Vector3, type ShaderMaterial } from "three";

import type { LineSegments2 } from "three/addons/lines/LineSegments2.js";

import { makeGround } from "../ground";
import { makeTerrainMaterial, type Tint } from "../material";
import { Network } from "../measure/network";
import type { Payload } from "../payload";
import { type Model, paintMaterial, SurfaceModel, type TerrainScene } from "../scene";
import { type Hit, join, type ProfilePoint, type Stretch, Surface, type SurfaceWords, type Terrain, type Vector } from "../surface";
import { type Part, readGlb } from "./glb";
import { type Mapping, transform } from "./mapping";
import { quote, type Source, TilesetError } from "./source";
import { makeTiles, readHead, type Tile } from "./tileset";
import { choose, type Choice } from "./traversal";

/** Pixels by which what is shown may be off. */
const MOST_ERROR = 3;
/** Of a tile that is exact, metres: far below a pixel. */
const LEAST_ERROR = 1e-9;
/** Requests at a time. */
const MOST_REQUESTS = 6;
/** Tiles whose elevations tell the range of all at the start: of a level with more, so many spread over it. */
const MOST_FIRST = 60;
/** Bytes of tiles that are kept, on a small screen and on another. */
const MOST_BYTES = [96e6, 384e6];
/** By how much coarser tiles are taken when those in view need more, and how far the view has to
 *  move, as a share of its distance, until finer ones are tried again. */
const [COARSER, MOVED] = [1.5, 0.2];
/** Share of a line by which two tiles may leave a gap: edges that are straight on one level bend a
 *  little on the next. */
const SEAM = 1e-4;
/** Depth of the apron of a tile, as a share of its width, at most. */
const MOST_SKIRT = 0.005;
/** Share of the ground over which triangles that face down mean that parts lie over others: those
 *  of rounding are far below. */
const OVERHANG = 1e-3;
/** Of a vertex and a triangle: arrays of the page and of the graphics card. */
const [VERTEX_BYTES, TRIANGLE_BYTES] = [80, 48];

interface Loaded {
  models: SurfaceModel[];
  /** Number of the first triangle of each model among all that were ever loaded. */
  firsts: number[];
}

/** The tiles that are shown, as one surface. */
class TilesetSurface implements Terrain {
  readonly difference = null;
  parts: [Tile, Loaded][] = [];

  constructor(
    readonly data: SurfaceWords,
    readonly low: Vector,
    readonly high: Vector,
  ) {}

  private *eachPart(): Generator<[SurfaceModel, number, Tile]> {
    for (const [tile, { models, firsts }] of this.parts)
      for (const [k, model] of models.entries()) yield [model, firsts[k], tile];
  }

  find(triangle: number): [Surface, number, Tile] | null {
    for (const [{ surface }, first, tile] of this.eachPart())
      if (triangle >= first && triangle < first + surface.triangleCount) return [surface, triangle - first, tile];
    return null;
  }

  pick(from: Vector, direction: Vector, lift: number): Hit | null {
    let best: Hit | null = null;
    let nearest = Infinity;
    for (const [{ surface }, first] of this.eachPart()) {
      const hit = surface.pick(from, direction, lift);
      if (hit === null) continue;
      const far = Math.hypot(hit.x - from[0], hit.y - from[1], hit.z * lift - from[2]);
      if (far < nearest) [nearest, best] = [far, { ...hit, triangle: first + hit.triangle }];
    }
    return best;
  }

  profile(from: [number, number], to: [number, number]): ProfilePoint[][] {
    const stretches: Stretch[] = [];
    for (const [{ surface }] of this.eachPart()) stretches.push(...surface.cutAll(from, to));
    return join(stretches, Math.hypot(to[0] - from[0], to[1] - from[1]), SEAM);
  }

  slope(triangle: number): number {
    const found = this.find(triangle);
    return found === null ? NaN : found[0].slope(found[1]);
  }

  differenceAt(): number {
    return NaN;
  }
}

export class TilesetModel implements Model {
  readonly group = new Group();
  readonly material: ShaderMaterial;
  readonly surface: TilesetSurface;
  readonly layers = new Map<string, LineSegments2>();
  readonly network = new Network([1, 1]);
  readonly labels = null;
  hasColors = false;
  /** Whether some of it lies above other parts. */
  hasOverhangs = false;
  /** What could not be read, one sentence each. */
  readonly failures: string[] = [];
  choice: Choice = { shown: [], wanted: [], used: [] };
  /** Bytes of all tiles that are kept, and how many at most. */
  bytes = 0;
  mostBytes: number;
  /** Whether the view needs more than is kept, and there are no coarser tiles: some are left out. */
  isFull = false;
  /** Called when other tiles are shown, and when something could not be read. */
  changed: () => void = () => undefined;
  failed: () => void = () => undefined;

  private readonly loaded = new Map<Tile, Loaded>();
  private readonly requests = new Map<Tile, AbortController>();
  private readonly ground;
  private scene: TerrainScene | null = null;
  private round = 0;
  private count = 0;
  private strain = 1;
  private strainedAt: Vector3 | null = null;
  private hasEdges = false;
  private isCoarse = false;
  private waiting: (() => void)[] = [];

  constructor(
    readonly root: Tile,
    private readonly source: Source,
    private readonly mapping: Mapping,
    private readonly payload: Payload,
    isSmall: boolean,
  ) {
    this.mostBytes = MOST_BYTES[isSmall ? 0 : 1];
    this.surface = new TilesetSurface({ name: payload.title, lines: [] }, root.low, root.high);
    this.material = makeTerrainMaterial(1, payload.colors, payload.origin[2]);
    this.ground = makeGround(payload);
  }

  /** Read the first level that has contents; return the elevations of its vertices.
   *
   *  Throws if none can be read. */
  async begin(): Promise<number[]> {
    let level = [this.root];
    while (level.length > 0) {
      await this.loadSome(level.filter(({ contents }) => contents.length > 0));
      const heights: number[] = [];
      for (const { models } of this.loaded.values())
        for (const { surface } of models)
          for (let i = 2; i < surface.positions.length; i += 3) heights.push(surface.positions[i]);
      if (heights.length > 0) return heights;
      level = level.flatMap(({ children }) => children);
    }
    throw new TilesetError(this.failures[0] ?? `${quote(this.source.root)} has no triangles to show.`);
  }

  /** Read tiles of a level, spread over it, a few at a time, as long as there is memory. */
  private async loadSome(level: Tile[]): Promise<void> {
    const step = Math.max(1, level.length / MOST_FIRST);
    const some = Array.from({ length: Math.min(level.length, MOST_FIRST) }, (_, k) => level[Math.floor(k * step)]);
    for (let k = 0; k < some.length && this.bytes <= this.mostBytes; k += MOST_REQUESTS)
      await Promise.all(some.slice(k, k + MOST_REQUESTS).map((tile) => this.load(tile)));
  }

  /** Follow the view of a scene. */
  follow(scene: TerrainScene): void {
    this.scene = scene;
    scene.prepared.push(() => this.update());
  }

  /** For scripts that try other trees. */
  static readonly choose = choose;

  // ------------------------------------------------------------ what is shown

  private update(): void {
    const scene = this.scene!;
    this.round += 1;
    this.relax(scene);
    const frustum = new Frustum().setFromProjectionMatrix(
      new Matrix4().multiplyMatrices(scene.camera.projectionMatrix, scene.camera.matrixWorldInverse),
    );
    const eye = scene.camera.position;
    const perDistance = scene.pixelsPerSlope;
    const box = new Box3();
    const measure = (tile: Tile): number | null => {
      box.min.set(tile.low[0], tile.low[1], tile.low[2] * scene.lift);
      box.max.set(tile.high[0], tile.high[1], tile.high[2] * scene.lift);
      if (!frustum.intersectsBox(box)) return null;
      // Heights are exaggerated, and so is what they are off by. Of exact tiles the nearest come first.
      return (Math.max(tile.error, LEAST_ERROR) * Math.max(1, scene.lift) * perDistance) / box.distanceToPoint(eye);
    };
    this.choice = choose(this.root, measure, MOST_ERROR * this.strain);
    for (const tile of this.choice.used) tile.used = this.round;
    this.show(this.choice.shown);
    this.forget();
    if (this.isFull) this.choice.wanted = [];
    this.request(this.choice.wanted);
    if (this.isSettled) for (const act of this.waiting.splice(0)) act();
  }

  private show(tiles: Tile[]): void {
    const before = new Set(this.surface.parts.map(([tile]) => tile));
    const now = new Set(tiles);
    if (before.size === now.size && tiles.every((tile) => before.has(tile))) return;
    for (const [tile, { models }] of this.surface.parts)
      if (!now.has(tile)) for (const { group } of models) this.group.remove(group);
    this.surface.parts = tiles.map((tile) => [tile, this.loaded.get(tile)!]);
    for (const [tile, { models }] of this.surface.parts)
      if (!before.has(tile))
        for (const model of models) {
          model.showEdges(this.hasEdges);
          model.setCoarse(this.isCoarse);
          this.group.add(model.group);
          model.group.updateMatrixWorld();
        }
    this.changed();
  }

  /** Whether all that the view needs is there, or cannot be had. */
  get isSettled(): boolean {
    return this.choice.wanted.length === 0 && this.requests.size === 0;
  }

  /** Wait until all that the view needs is there. */
  async settle(): Promise<void> {
    this.scene?.request();
    await new Promise<void>((done) => this.waiting.push(done));
  }

  /** Largest error of the tiles that are shown, metres. */
  get error(): number {
    return Math.max(0, ...this.surface.parts.map(([tile]) => tile.error));
  }

  get triangleCount(): number {
    let sum = 0;
    for (const [, { models }] of this.surface.parts) for (const { surface } of models) sum += surface.triangleCount;
    return sum;
  }

  // ------------------------------------------------------------ requests and memory

  private request(wanted: Tile[]): void {
    const urgent = new Set(wanted);
    for (const [tile, control] of this.requests)
      if (!urgent.has(tile)) {
        control.abort();
        this.requests.delete(tile);
        tile.state = "none";
      }
    for (const tile of wanted) {
      if (this.requests.size >= MOST_REQUESTS) return;
      if (tile.state === "none") void this.load(tile).then(() => this.scene?.request());
    }
  }

  private async load(tile: Tile): Promise<void> {
    const control = new AbortController();
    this.requests.set(tile, control);
    tile.state = "loading";
    try {
      const parts: Part[] = [];
      const inner: [string, ArrayBuffer][] = [];
      for (const path of tile.contents) {
        const bytes = await this.source.read(path, control.signal);
        if (isJson(bytes)) inner.push([path, bytes]);
        else parts.push(...readContent(bytes, path));
      }
      if (control.signal.aborted) return;
      for (const [path, bytes] of inner) this.addTileset(tile, path, bytes);
      this.keep(tile, parts);
    } catch (error) {
      if (control.signal.aborted) return;
      tile.state = "failed";
      this.failures.push(error instanceof TilesetError ? error.message : `${tile.contents[0]} cannot be shown: ${String(error)}`);
      this.failed();
    } finally {
      if (this.requests.get(tile) === control) this.requests.delete(tile);
    }
  }

  private addTileset(tile: Tile, path: string, bytes: ArrayBuffer): void {
    for (let above: Tile | null = tile; above !== null; above = above.parent)
      if (above.home === path) throw new TilesetError(`${tile.home} names ${path}, in which it stands itself.`);
    const head = readHead(new TextDecoder().decode(bytes), path);
    makeTiles(head, path, this.mapping, tile);
  }

  private keep(tile: Tile, parts: Part[]): void {
    const loaded: Loaded = { models: [], firsts: [] };
    for (const part of parts) {
      const surface = this.place(tile, part);
      if (surface === null) continue;
      const middle = [0, 1].map((k) => (surface.low[k] + surface.high[k]) / 2) as [number, number];
      const width = Math.max(surface.high[0] - surface.low[0], surface.high[1] - surface.low[1]);
      // A neighbour may be of the level above.
      const skirt = Math.min(tile.parent?.error ?? tile.error, MOST_SKIRT * width);
      const model = new SurfaceModel(surface, this.payload, [1, 1], this.material, middle, { colors: part.colors, skirt });
      this.hasColors ||= part.colors !== null;
      loaded.models.push(model);
      loaded.firsts.push(this.count);
      this.count += surface.triangleCount;
      tile.bytes += VERTEX_BYTES * (surface.positions.length / 3) + TRIANGLE_BYTES * surface.triangleCount;
    }
    tile.state = loaded.models.length > 0 ? "ready" : "empty";
    if (tile.state === "ready") this.loaded.set(tile, loaded);
    this.bytes += tile.bytes;
  }

  /** Return a part of a content on the page, its triangles counter-clockwise from above. */
  private place(tile: Tile, { positions, triangles }: Part): Surface | null {
    if (triangles.length === 0) return null;
    const placed = new Float64Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
      const there = transform(tile.transform, [positions[i], positions[i + 1], positions[i + 2]]);
      placed.set(this.mapping.place(there), i);
    }
    let [up, down] = [0, 0];
    const turned = new Uint32Array(triangles);
    for (let k = 0; k < turned.length; k += 3) {
      const [a, b, c] = [3 * turned[k], 3 * turned[k + 1], 3 * turned[k + 2]];
      const area = (placed[b] - placed[a]) * (placed[c + 1] - placed[a + 1]) - (placed[b + 1] - placed[a + 1]) * (placed[c] - placed[a]);
      if (area > 0) up += area;
      if (area >= 0) continue;
      down -= area;
      [turned[k + 1], turned[k + 2]] = [turned[k + 2], turned[k + 1]];
    }
    this.hasOverhangs ||= Math.min(up, down) > OVERHANG * Math.max(up, down);
    return new Surface(this.surface.data, placed, turned, null, 1, this.ground);
  }

  /** Let go of what has not been of use for longest, while there is more than is kept. */
  private forget(): void {
    this.isFull = false;
    if (this.bytes <= this.mostBytes) return;
    const old = [...this.loaded.keys()].filter((tile) => tile.used < this.round).sort((a, b) => a.used - b.used);
    for (const tile of old) {
      if (this.bytes <= this.mostBytes) return;
      for (const model of this.loaded.get(tile)!.models) model.dispose();
      this.loaded.delete(tile);
      this.bytes -= tile.bytes;
      [tile.bytes, tile.state] = [0, "none"];
    }
    const { shown, wanted } = this.choice;
    if (this.bytes <= this.mostBytes || (shown.length < 2 && wanted.length === 0)) return;
    if (!shown.some(hasCoarser)) {
      this.isFull = wanted.length > 0;
      return;
    }
    // All of it is in view: coarser tiles have to do.
    this.strain *= COARSER;
    this.strainedAt = this.scene!.camera.position.clone();
    this.scene!.request();
  }

  private relax({ camera, controls }: TerrainScene): void {
    if (this.strainedAt === null) return;
    const away = camera.position.distanceTo(controls.target);
    if (camera.position.distanceTo(this.strainedAt) < MOVED * away) return;
    this.strain = Math.max(1, this.strain / COARSER);
    this.strainedAt = this.strain > 1 ? camera.position.clone() : null;
  }

  // ------------------------------------------------------------ as a model

  setCoarse(isCoarse: boolean): void {
    this.isCoarse = isCoarse;
    for (const [, { models }] of this.surface.parts) for (const model of models) model.setCoarse(isCoarse);
  }

  showEdges(shown: boolean): void {
    this.hasEdges = shown;
    for (const [, { models }] of this.surface.parts) for (const model of models) model.showEdges(shown);
  }

  paint(tint: Tint, ramps: Parameters<Model["paint"]>[1], range: [number, number]): void {
    paintMaterial(this.material, tint, ramps, range);
  }

  describeExactness(path: Hit[]): string {
    if (path.length === 1) {
      const found = this.surface.find(path[0].triangle);
      return found === null ? "" : `Geometric error of this level ${formatError(found[2].error)}`;
    }
    const ends = [0, 1].map((k) => path.map((hit) => (k === 0 ? hit.x : hit.y)));
    const [low, high] = [ends.map((one) => Math.min(...one)), ends.map((one) => Math.max(...one))];
    const crossed = this.surface.parts.filter(([tile]) => [0, 1].every((k) => tile.low[k] <= high[k] && tile.high[k] >= low[k]));
    const error = Math.max(0, ...crossed.map(([tile]) => tile.error));
    const overhangs = this.hasOverhangs ? " Parts of the tiles lie over others: the profile has one of them." : "";
    return `Measured on the levels shown, geometric error up to ${formatError(error)}.${overhangs}`;
  }
}

export function formatError(error: number): string {
  return `${Number(error.toPrecision(2))} m`;
}

/** Whether a tile has one above it that can stand in its place. */
function hasCoarser({ parent }: Tile): boolean {
  for (let one = parent; one !== null; one = one.parent)
    if (one.isReplaced && one.contents.length > 0 && one.state !== "failed" && one.state !== "empty") return true;
  return false;
}

function isJson(bytes: ArrayBuffer): boolean {
  const text = new TextDecoder().decode(new Uint8Array(bytes, 0, Math.min(64, bytes.byteLength)));
  return text.trimStart().startsWith("{");
}

function readContent(bytes: ArrayBuffer, path: string): Part[] {
  try {
    return readGlb(bytes, path);
  } catch (error) {
    if (error instanceof TilesetError) throw error;
    throw new TilesetError(`${path} is damaged: its JSON does not hold what glTF asks for.`);
  }
}
