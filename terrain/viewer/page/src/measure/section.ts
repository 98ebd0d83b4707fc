/** Sections: every surface along a line of places, drawn and as a table. */

import type { Marked } from "../annotations";
import { fix } from "../elements";
import type { Factors } from "../ground";
import type { Payload } from "../payload";
import type { ProfilePoint, Terrain } from "../surface";
import { measureSegment } from "./measuring";

type Ground = (y: number) => Factors;

/** Share of a segment within which two stations are one. */
const SAME = 1e-9;
/** Decimals of the table beyond those that are shown. */
const MORE_DECIMALS = 3;

/** One straight part of a line: where it begins, in stations, and each surface along it. */
export interface Segment {
  a: { x: number; y: number };
  b: { x: number; y: number };
  /** Station of its start, and its length, on the ground. */
  start: number;
  length: number;
  /** Of each surface the stretches (distance in units of the page, elevation) on it. */
  pieces: ProfilePoint[][][];
}

/** Cut surfaces along a line. `owner` is the surface of which the line is part, if it is: then it
 *  runs along edges, between whose ends the surface is straight. */
export function cutSection(path: Marked[], surfaces: Terrain[], ground: Ground, owner?: Terrain): Segment[] {
  const segments: Segment[] = [];
  let start = 0;
  for (let k = 0; k + 1 < path.length; k += 1) {
    const [a, b] = [path[k].hit, path[k + 1].hit];
    const length = measureSegment(a, b, ground);
    const plain = Math.hypot(b.x - a.x, b.y - a.y);
    const pieces = surfaces.map((surface): ProfilePoint[][] => {
      if (surface === owner) return plain > 0 ? [[[0, a.z], [plain, b.z]]] : [];
      return surface.profile([a.x, a.y], [b.x, b.y]);
    });
    segments.push({ a, b, start, length, pieces });
    start += length;
  }
  return segments;
}

/** Return one surface of a section as a curve: stretches of (station, elevation). */
export function traceCurve(segments: Segment[], k: number): ProfilePoint[][] {
  return segments.flatMap((segment) => {
    const factor = stretch(segment);
    return segment.pieces[k].map((piece) =>
      piece.map(([distance, z]): ProfilePoint => [segment.start + factor * distance, z]),
    );
  });
}

function stretch({ a, b, length }: Segment): number {
  return length / (Math.hypot(b.x - a.x, b.y - a.y) || 1);
}

/** A row: station, place, and the elevation of each surface, NaN where it is not. */
export type Row = [station: number, x: number, y: number, ...elevations: number[]];

/** Return a row wherever the line bends or crosses an edge of a surface, and one without elevation
 *  in the middle of each gap. */
export function tabulate(segments: Segment[]): Row[] {
  const rows: Row[] = [];
  for (const segment of segments) {
    const { a, b, start, length, pieces } = segment;
    const plain = Math.hypot(b.x - a.x, b.y - a.y);
    if (plain === 0) continue;
    for (const distance of listDistances(pieces, plain)) {
      if (rows.length > 0 && distance === 0) continue;
      const share = distance / plain;
      const elevations = pieces.map((one) => elevationAt(one, distance, SAME * plain));
      rows.push([
        start + share * length,
        a.x + share * (b.x - a.x),
        a.y + share * (b.y - a.y),
        ...elevations,
      ]);
    }
  }
  return rows;
}

function listDistances(pieces: ProfilePoint[][][], length: number): number[] {
  const all = [0, length];
  for (const surface of pieces)
    surface.forEach((piece, k) => {
      for (const [distance] of piece) all.push(distance);
      if (k > 0) all.push((surface[k - 1][surface[k - 1].length - 1][0] + piece[0][0]) / 2);
    });
  all.sort((a, b) => a - b);
  const kept: number[] = [];
  for (const one of all) if (kept.length === 0 || one - kept[kept.length - 1] > SAME * length) kept.push(one);
  // The end itself, where the last crossing is within the tolerance of it.
  kept[kept.length - 1] = length;
  return kept;
}

function elevationAt(pieces: ProfilePoint[][], distance: number, tolerance: number): number {
  for (const piece of pieces) {
    if (distance < piece[0][0] - tolerance || distance > piece[piece.length - 1][0] + tolerance) continue;
    let [low, high] = [0, piece.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (piece[middle][0] <= distance) low = middle;
      else high = middle;
    }
    const [[d0, z0], [d1, z1]] = [piece[low], piece[high]];
    const share = d1 > d0 ? Math.min(Math.max((distance - d0) / (d1 - d0), 0), 1) : 0;
    return z0 + share * (z1 - z0);
  }
  return NaN;
}

/** Write a section as CSV: station, coordinates of the CRS, elevation of each surface. */
export function writeCsv(segments: Segment[], names: string[], payload: Payload): string {
  const { axes, origin, scale, units, geographic, decimals, elevationName } = payload;
  const word = elevationName.toLowerCase();
  const [across, up] = [decimals[0] + MORE_DECIMALS, decimals[1] + MORE_DECIMALS];
  const places = geographic ? 10 : across;
  const horizontal = geographic ? "degree" : units.horizontal;
  const header = [
    withUnit("station", units.horizontal),
    withUnit(geographic ? "longitude" : axes[0][0].toLowerCase(), horizontal),
    withUnit(geographic ? "latitude" : axes[1][0].toLowerCase(), horizontal),
    ...names.map((name) => withUnit(names.length > 1 ? `${word} ${name}` : word, units.elevation)),
  ];
  const lines = tabulate(segments).map(([station, x, y, ...elevations]) =>
    [
      fix(station, across),
      fix(axes[0][1] * (x / scale[0] + origin[0]), places),
      fix(axes[1][1] * (y / scale[1] + origin[1]), places),
      ...elevations.map((z) => (Number.isNaN(z) ? "" : fix(z + origin[2], up))),
    ].join(","),
  );
  return `${[header.map(quote).join(","), ...lines].join("\r\n")}\r\n`;
}

function withUnit(words: string, unit: string): string {
  return unit === "" ? words : `${words} (${unit})`;
}

function quote(text: string): string {
  const line = text.replace(/\s+/g, " ");
  return /[",]/.test(line) ? `"${line.replace(/"/g, '""')}"` : line;
}
