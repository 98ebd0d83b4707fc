/** The lines of a surface as a graph: the place on them next to a pixel, and the way along them. */

import type { Lines } from "../unpacking";

export type Place = [x: number, y: number, z: number];

/** A place on an edge of the graph. */
export interface OnLine {
  from: number;
  to: number;
  place: Place;
}

/** Where a place is on the screen: pixels, and its depth as the divisor of perspective. */
export type ToScreen = (place: Place) => [px: number, py: number, depth: number] | null;

export class Network {
  /** x, y, z of the vertices, from the origin. */
  private readonly places: number[] = [];
  private readonly edges = new Map<string, number[]>();
  private readonly numbers = new Map<string, number>();
  private readonly neighbours: number[][] = [];

  constructor(private readonly step: [number, number]) {}

  get isEmpty(): boolean {
    return this.places.length === 0;
  }

  /** Add lines of a kind, vertices in whole steps: equal vertices are one. */
  add(kind: string, { vertices, offsets }: Lines): void {
    const pairs: number[] = [];
    for (let k = 0; k + 1 < offsets.length; k += 1) {
      let before = -1;
      for (let i = offsets[k]; i < offsets[k + 1]; i += 1) {
        const now = this.number(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
        if (before >= 0 && before !== now) {
          pairs.push(before, now);
          this.neighbours[before].push(now);
          this.neighbours[now].push(before);
        }
        before = now;
      }
    }
    this.edges.set(kind, pairs);
  }

  private number(x: number, y: number, z: number): number {
    const key = `${x} ${y} ${z}`;
    const known = this.numbers.get(key);
    if (known !== undefined) return known;
    const [across, up] = this.step;
    this.places.push(x * across, y * across, z * up);
    this.neighbours.push([]);
    this.numbers.set(key, this.neighbours.length - 1);
    return this.neighbours.length - 1;
  }

  vertex(k: number): Place {
    return [this.places[3 * k], this.places[3 * k + 1], this.places[3 * k + 2]];
  }

  /** Return the places on lines of these kinds within so many pixels of one, the nearest first. */
  reach(px: number, py: number, kinds: Set<string>, most: number, toScreen: ToScreen): OnLine[] {
    const screen = this.neighbours.map((_, k) => toScreen(this.vertex(k)));
    const found: [number, OnLine][] = [];
    for (const [kind, pairs] of this.edges) {
      if (!kinds.has(kind)) continue;
      for (let k = 0; k < pairs.length; k += 2) {
        const [from, to] = [pairs[k], pairs[k + 1]];
        const [a, b] = [screen[from], screen[to]];
        if (a === null || b === null) continue;
        const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        const along = ((px - a[0]) * dx + (py - a[1]) * dy) / (dx * dx + dy * dy || 1);
        const s = Math.min(Math.max(along, 0), 1);
        const off = Math.hypot(px - a[0] - s * dx, py - a[1] - s * dy);
        if (off > most) continue;
        // The share on the screen is not that in space: what is near is drawn longer.
        const t = (s * a[2]) / ((1 - s) * b[2] + s * a[2]);
        found.push([off, { from, to, place: mix(this.vertex(from), this.vertex(to), t) }]);
      }
    }
    return found.sort((a, b) => a[0] - b[0]).map(([, one]) => one);
  }

  /** Return the shortest way along the lines from one place to another, both included; null where
   *  the lines do not lead there. Dijkstra, "A note on two problems in connexion with graphs" (1959). */
  findWay(start: OnLine, end: OnLine, measure: (a: Place, b: Place) => number): Place[] | null {
    const edge = (one: OnLine): string => `${Math.min(one.from, one.to)} ${Math.max(one.from, one.to)}`;
    if (edge(start) === edge(end)) return [start.place, end.place];
    const lengths = new Map<number, number>();
    const before = new Map<number, number>();
    const queue = new Queue();
    for (const k of [start.from, start.to]) {
      lengths.set(k, measure(start.place, this.vertex(k)));
      queue.push(lengths.get(k)!, k);
    }
    let [best, last] = [Infinity, -1];
    const done = new Set<number>();
    for (let next = queue.pop(); next !== null && next[0] < best; next = queue.pop()) {
      const [length, k] = next;
      if (done.has(k)) continue;
      done.add(k);
      if (k === end.from || k === end.to) {
        const whole = length + measure(this.vertex(k), end.place);
        if (whole < best) [best, last] = [whole, k];
      }
      for (const other of this.neighbours[k]) {
        const longer = length + measure(this.vertex(k), this.vertex(other));
        if (longer >= (lengths.get(other) ?? Infinity)) continue;
        lengths.set(other, longer);
        before.set(other, k);
        queue.push(longer, other);
      }
    }
    if (last < 0) return null;
    const way: Place[] = [end.place];
    for (let k: number | undefined = last; k !== undefined; k = before.get(k)) way.push(this.vertex(k));
    return dropRepeated([...way, start.place].reverse());
  }
}

function mix(a: Place, b: Place, t: number): Place {
  return [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])];
}

function dropRepeated(way: Place[]): Place[] {
  return way.filter((one, k) => k === 0 || one.some((value, axis) => value !== way[k - 1][axis]));
}

/** Numbers by their keys, the least first: a binary heap. */
class Queue {
  private readonly heap: [number, number][] = [];

  push(key: number, value: number): void {
    let k = this.heap.push([key, value]) - 1;
    for (let up = (k - 1) >> 1; k > 0 && this.heap[up][0] > key; up = (k - 1) >> 1) {
      [this.heap[k], this.heap[up]] = [this.heap[up], this.heap[k]];
      k = up;
    }
  }

  pop(): [number, number] | null {
    const { heap } = this;
    const last = heap.pop();
    if (last === undefined || heap.length === 0) return last ?? null;
    const first = heap[0];
    heap[0] = last;
    for (let k = 0; ; ) {
      let least = k;
      for (const down of [2 * k + 1, 2 * k + 2])
        if (down < heap.length && heap[down][0] < heap[least][0]) least = down;
      if (least === k) return first;
      [heap[k], heap[least]] = [heap[least], heap[k]];
      k = least;
    }
  }
}
