/** A surface in numbers: where a place lies on it, what a ray hits, what a line crosses. */

import type { Factors } from "./ground";
import type { SurfaceData } from "./payload";
import { unpackRows, unpackTriangles } from "./unpacking";

export type Vector = [number, number, number];

/** A place on the surface, in coordinates from the surface's origin. */
export interface Hit {
  triangle: number;
  x: number;
  y: number;
  z: number;
}

/** A stretch of a profile inside one triangle: distances along the line and elevations. */
export interface Stretch {
  from: number;
  to: number;
  zFrom: number;
  zTo: number;
}

export type ProfilePoint = [distance: number, elevation: number];

/** What a surface is called, and which lines are drawn with it. */
export type SurfaceWords = Pick<SurfaceData, "name" | "lines">;

/** What can be measured on: one surface, or the tiles of one. */
export type Terrain = Pick<Surface, "low" | "high" | "difference" | "pick" | "profile" | "slope" | "differenceAt"> & {
  readonly data: SurfaceWords;
};

const TRIANGLES_PER_CELL = 2;

/** Share of a triangle by which a ray may pass beside it: no gap opens where rounding parts two. */
const SEAM = 1e-9;

/** Of a step: what rounding takes a place off it, at most. */
const OFF_STEP = 1e-3;

export class Surface {
  readonly low: Vector = [Infinity, Infinity, Infinity];
  readonly high: Vector = [-Infinity, -Infinity, -Infinity];

  private columns = 1;
  private rows = 1;
  private cell = 1;
  private starts = new Int32Array(2);
  /** Triangles by cells; null until they are needed. */
  private members: Int32Array | null = null;
  private seen = new Int32Array(0);
  private round = 0;

  constructor(
    readonly data: SurfaceWords,
    /** x, y, z of each vertex from the origin, in units of the coordinates. */
    readonly positions: Float64Array,
    readonly triangles: Uint32Array,
    /** Cut and fill at the vertices. */
    readonly difference: Float32Array | null,
    /** Horizontal units in one unit of elevation. */
    readonly elevationScale: number,
    readonly ground: (y: number) => Factors,
    /** Coordinates are whole numbers of this, across; 0 where they are any. */
    private readonly step = 0,
  ) {
    for (let i = 0; i < positions.length; i += 1) {
      this.low[i % 3] = Math.min(this.low[i % 3], positions[i]);
      this.high[i % 3] = Math.max(this.high[i % 3], positions[i]);
    }
  }

  static async unpack(
    data: SurfaceData,
    elevationScale: number,
    ground: (y: number) => Factors,
  ): Promise<Surface> {
    const vertices = await unpackRows(data.vertices);
    const triangles = await unpackTriangles(data.triangles);
    const steps = data.difference === null ? null : await unpackRows(data.difference);
    const difference = steps === null ? null : Float32Array.from(steps, (n) => n * data.step[1]);
    const [across, up] = data.step;
    const positions = Float64Array.from(vertices, (n, i) => n * (i % 3 === 2 ? up : across));
    const surface = new Surface(data, positions, triangles, difference, elevationScale, ground, across);
    surface.fillCells();
    return surface;
  }

  get triangleCount(): number {
    return this.triangles.length / 3;
  }

  /** Return the steepness of a triangle in degrees, both units taken into account. */
  slope(triangle: number): number {
    const [a, b, c] = this.corners(triangle);
    const s = this.elevationScale;
    const [east, north] = this.ground((a[1] + b[1] + c[1]) / 3);
    const u = [(b[0] - a[0]) * east, (b[1] - a[1]) * north, (b[2] - a[2]) * s];
    const v = [(c[0] - a[0]) * east, (c[1] - a[1]) * north, (c[2] - a[2]) * s];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    return (Math.atan2(Math.hypot(n[0], n[1]), n[2]) * 180) / Math.PI;
  }

  /** Return the first place that a ray hits; z of both is in horizontal units times ``lift``. */
  pick(from: Vector, direction: Vector, lift: number): Hit | null {
    const span = this.clipRay(from, direction, lift);
    if (span === null) return null;
    const members = this.members ?? this.fillCells();
    this.round += 1;
    let best = Infinity;
    let found = -1;
    for (const [cell, leave] of this.walk(from, direction, span[0], span[1])) {
      for (let k = this.starts[cell]; k < this.starts[cell + 1]; k += 1) {
        const triangle = members[k];
        if (this.seen[triangle] === this.round) continue;
        this.seen[triangle] = this.round;
        const t = this.intersect(triangle, from, direction, lift);
        if (t < best) {
          best = t;
          found = triangle;
        }
      }
      if (best <= leave) break;
    }
    if (found < 0) return null;
    const x = from[0] + best * direction[0];
    const y = from[1] + best * direction[1];
    // Of the plane, not of the ray, whose digits end where the camera is far away.
    const z = this.planeAt(this.corners(found), [x, y], [0, 0, 0], 0);
    // A triangle that stands upright has no plane over the map.
    return { triangle: found, x, y, z: Number.isFinite(z) ? z : (from[2] + best * direction[2]) / lift };
  }

  /** Return the surface along a line: pieces of (distance, elevation), with gaps where it is off. */
  profile(from: [number, number], to: [number, number]): ProfilePoint[][] {
    return join(this.cutAll(from, to), Math.hypot(to[0] - from[0], to[1] - from[1]), SEAM);
  }

  /** Return the stretches of a line inside triangles, in any order. */
  cutAll(from: [number, number], to: [number, number]): Stretch[] {
    const stretches: Stretch[] = [];
    [from, to] = [this.onStep(from), this.onStep(to)];
    const direction: Vector = [to[0] - from[0], to[1] - from[1], 0];
    if (direction[0] === 0 && direction[1] === 0) return [];
    const members = this.members ?? this.fillCells();
    this.round += 1;
    for (const [cell] of this.walk([from[0], from[1], 0], direction, 0, 1)) {
      for (let k = this.starts[cell]; k < this.starts[cell + 1]; k += 1) {
        const triangle = members[k];
        if (this.seen[triangle] === this.round) continue;
        this.seen[triangle] = this.round;
        const stretch = this.cut(triangle, from, to);
        if (stretch !== null) stretches.push(stretch);
      }
    }
    return stretches;
  }

  /** Return cut or fill at a place. */
  differenceAt({ triangle, x, y }: Hit): number {
    const corners = this.corners(triangle);
    corners.forEach((corner, k) => (corner[2] = this.difference![this.triangles[3 * triangle + k]]));
    return this.planeAt(corners, [x, y], [0, 0, 0], 0);
  }

  corners(triangle: number): [Vector, Vector, Vector] {
    return [this.vertex(triangle, 0), this.vertex(triangle, 1), this.vertex(triangle, 2)];
  }

  private vertex(triangle: number, corner: number): Vector {
    const i = 3 * this.triangles[3 * triangle + corner];
    return [this.positions[i], this.positions[i + 1], this.positions[i + 2]];
  }

  /** Moeller and Trumbore (1997): where along the ray the triangle is hit, infinity if it is not. */
  private intersect(triangle: number, from: Vector, direction: Vector, lift: number): number {
    const [a, b, c] = this.corners(triangle);
    const e: Vector = [b[0] - a[0], b[1] - a[1], (b[2] - a[2]) * lift];
    const f: Vector = [c[0] - a[0], c[1] - a[1], (c[2] - a[2]) * lift];
    const p = cross(direction, f);
    const determinant = dot(e, p);
    if (determinant === 0) return Infinity;
    const s: Vector = [from[0] - a[0], from[1] - a[1], from[2] - a[2] * lift];
    const u = dot(s, p) / determinant;
    if (u < -SEAM || u > 1 + SEAM) return Infinity;
    const q = cross(s, e);
    const v = dot(direction, q) / determinant;
    if (v < -SEAM || u + v > 1 + SEAM) return Infinity;
    const t = dot(f, q) / determinant;
    return t >= 0 ? t : Infinity;
  }

  /** Return a place that is a whole number of steps but for rounding as a vertex there would be. */
  private onStep([x, y]: [number, number]): [number, number] {
    const round = (value: number): number => {
      const whole = Math.round(value / this.step);
      return Math.abs(value / this.step - whole) < OFF_STEP ? whole * this.step : value;
    };
    return this.step > 0 ? [round(x), round(y)] : [x, y];
  }

  /** Return a place in steps: whole numbers, with which it is exact on which side of an edge the
   *  ends of a line lie, so that one along edges is on the surface as ``ts.profile`` tells. */
  private inSteps([x, y]: [number, number] | Vector): [number, number] {
    const count = (value: number): number => {
      const whole = Math.round(value / this.step);
      return whole * this.step === value ? whole : value / this.step;
    };
    return this.step > 0 ? [count(x), count(y)] : [x, y];
  }

  /** Return the stretch of a line (parameter 0 to 1) inside a triangle, seen from above. */
  private cut(triangle: number, from: [number, number], to: [number, number]): Stretch | null {
    const corners = this.corners(triangle);
    const steps = corners.map((corner) => this.inSteps(corner));
    const [start, end] = [this.inSteps(from), this.inSteps(to)];
    const [p, q, r] = steps;
    // A sliver that is a line in steps would be everywhere along it, at no certain elevation.
    if ((q[0] - p[0]) * (r[1] - p[1]) === (q[1] - p[1]) * (r[0] - p[0])) return null;
    let low = 0;
    let high = 1;
    for (let k = 0; k < 3; k += 1) {
      const a = steps[k];
      const b = steps[(k + 1) % 3];
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
      const side = dx * (start[1] - a[1]) - dy * (start[0] - a[0]);
      const change = dx * (end[1] - start[1]) - dy * (end[0] - start[0]);
      if (change === 0) {
        if (side < 0) return null;
      } else if (change > 0) low = Math.max(low, -side / change);
      else high = Math.min(high, -side / change);
    }
    if (!(low < high)) return null;
    const direction: Vector = [to[0] - from[0], to[1] - from[1], 0];
    const at = (t: number): number => this.planeAt(corners, from, direction, t);
    return { from: low, to: high, zFrom: at(low), zTo: at(high) };
  }

  private planeAt(
    corners: [Vector, Vector, Vector],
    from: [number, number],
    direction: Vector,
    t: number,
  ): number {
    const [a, b, c] = corners;
    const [x, y] = [from[0] + t * direction[0] - a[0], from[1] + t * direction[1] - a[1]];
    const [ux, uy, vx, vy] = [b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]];
    const area = ux * vy - uy * vx;
    const v = (ux * y - uy * x) / area;
    const u = (x * vy - y * vx) / area;
    return a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
  }

  /** Sort the triangles into square cells by the boxes around them. */
  private fillCells(): Int32Array {
    this.seen = new Int32Array(this.triangleCount);
    const width = this.high[0] - this.low[0];
    const height = this.high[1] - this.low[1];
    const wanted = Math.max(1, this.triangleCount / TRIANGLES_PER_CELL);
    this.cell = Math.max(Math.sqrt((width * height) / wanted), Math.max(width, height) / 4096) || 1;
    this.columns = Math.floor(width / this.cell) + 1;
    this.rows = Math.floor(height / this.cell) + 1;
    this.starts = new Int32Array(this.columns * this.rows + 2);
    this.eachCell((cell) => (this.starts[cell + 2] += 1));
    for (let k = 2; k < this.starts.length; k += 1) this.starts[k] += this.starts[k - 1];
    const members = new Int32Array(this.starts[this.starts.length - 1]);
    this.eachCell((cell, triangle) => {
      members[this.starts[cell + 1]] = triangle;
      this.starts[cell + 1] += 1;
    });
    this.members = members;
    return members;
  }

  private eachCell(take: (cell: number, triangle: number) => void): void {
    const { triangles, positions: p } = this;
    for (let t = 0; t < this.triangleCount; t += 1) {
      const [a, b, c] = [3 * triangles[3 * t], 3 * triangles[3 * t + 1], 3 * triangles[3 * t + 2]];
      const bottom = this.rowOf(Math.min(p[a + 1], p[b + 1], p[c + 1]));
      const top = this.rowOf(Math.max(p[a + 1], p[b + 1], p[c + 1]));
      for (let row = bottom; row <= top; row += 1) {
        const [left, right] = this.columnsOf(a, b, c, bottom === top ? -1 : row);
        for (let column = left; column <= right; column += 1) take(row * this.columns + column, t);
      }
    }
  }

  /** Return the columns that a triangle reaches in a row, or in any if the row is -1: all of the
   *  box around a long triangle aslant would be most of the cells. */
  private columnsOf(a: number, b: number, c: number, row: number): [number, number] {
    const p = this.positions;
    if (row < 0)
      return [this.columnOf(Math.min(p[a], p[b], p[c])), this.columnOf(Math.max(p[a], p[b], p[c]))];
    const margin = 1e-6 * this.cell;
    const low = this.low[1] + row * this.cell - margin;
    const high = low + this.cell + 2 * margin;
    let [left, right] = [Infinity, -Infinity];
    for (let k = 0; k < 3; k += 1) {
      const i = k === 0 ? a : k === 1 ? b : c;
      const j = k === 0 ? b : k === 1 ? c : a;
      const [y0, y1] = [p[i + 1], p[j + 1]];
      if (Math.max(y0, y1) < low || Math.min(y0, y1) > high) continue;
      const slant = y1 === y0 ? 0 : (p[j] - p[i]) / (y1 - y0);
      const x0 = y1 === y0 ? p[i] : p[i] + slant * (Math.min(Math.max(y0, low), high) - y0);
      const x1 = y1 === y0 ? p[j] : p[i] + slant * (Math.min(Math.max(y1, low), high) - y0);
      left = Math.min(left, x0, x1);
      right = Math.max(right, x0, x1);
    }
    return [
      Math.max(this.columnOf(left - margin), 0),
      Math.min(this.columnOf(right + margin), this.columns - 1),
    ];
  }

  private columnOf(x: number): number {
    return Math.floor((x - this.low[0]) / this.cell);
  }

  private rowOf(y: number): number {
    return Math.floor((y - this.low[1]) / this.cell);
  }

  /** Return from where to where along a ray it is inside the box around the surface. */
  private clipRay(from: Vector, direction: Vector, lift: number): [number, number] | null {
    const lifted = [lift * this.low[2], lift * this.high[2]];
    const margin = 1e-6 * (this.high[0] - this.low[0] + this.high[1] - this.low[1]);
    let near = 0;
    let far = Infinity;
    for (let axis = 0; axis < 3; axis += 1) {
      const low = (axis === 2 ? Math.min(...lifted) : this.low[axis]) - margin;
      const high = (axis === 2 ? Math.max(...lifted) : this.high[axis]) + margin;
      if (direction[axis] === 0) {
        if (from[axis] < low || from[axis] > high) return null;
        continue;
      }
      const ends = [(low - from[axis]) / direction[axis], (high - from[axis]) / direction[axis]];
      near = Math.max(near, Math.min(...ends));
      far = Math.min(far, Math.max(...ends));
    }
    return near <= far ? [near, far] : null;
  }

  /** Name the cells under a ray in their order, each with the parameter at which it is left.
   *  Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing" (1987). */
  private *walk(
    from: Vector,
    direction: Vector,
    near: number,
    far: number,
  ): Generator<[number, number]> {
    let column = this.columnOf(from[0] + near * direction[0]);
    let row = this.rowOf(from[1] + near * direction[1]);
    const [stepX, stepY] = [Math.sign(direction[0]), Math.sign(direction[1])];
    const border = (k: number, step: number): number => (k + (step > 0 ? 1 : 0)) * this.cell;
    const next = (axis: 0 | 1, k: number, step: number): number =>
      step === 0
        ? Infinity
        : (this.low[axis] + border(k, step) - from[axis]) / direction[axis];
    for (;;) {
      const [tx, ty] = [next(0, column, stepX), next(1, row, stepY)];
      const leave = Math.min(tx, ty);
      if (column >= 0 && column < this.columns && row >= 0 && row < this.rows)
        yield [row * this.columns + column, leave];
      if (leave >= far || leave === Infinity) return;
      if (tx <= ty) column += stepX;
      else row += stepY;
      if (this.isPast(column, stepX, this.columns) || this.isPast(row, stepY, this.rows)) return;
    }
  }

  private isPast(k: number, step: number, count: number): boolean {
    return (k < 0 && step <= 0) || (k >= count && step >= 0);
  }
}

/** Join stretches that follow each other; where the next begins further on, by more than a share of
 *  the length, there is a gap. */
export function join(stretches: Stretch[], length: number, seam: number): ProfilePoint[][] {
  stretches.sort((a, b) => a.from - b.from || a.to - b.to);
  const pieces: ProfilePoint[][] = [];
  let end = -1;
  for (const one of stretches) {
    if (one.to <= end) continue;
    const touches = pieces.length > 0 && one.from <= end + seam;
    if (!touches) pieces.push([[one.from * length, one.zFrom]]);
    pieces[pieces.length - 1].push([one.to * length, one.zTo]);
    end = one.to;
  }
  return pieces;
}

function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
