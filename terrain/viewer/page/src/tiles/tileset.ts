/** The tree of a tileset, as its JSON names it. */

import type { Vector } from "../surface";
import { IDENTITY, isOnGlobe, Mapping, type Matrix, multiply, RADIANS, transform } from "./mapping";
import { quote, resolve, TilesetError } from "./source";

const VERSIONS = ["1.0", "1.1"];
const KNOWN_EXTENSIONS = ["3DTILES_content_gltf"];
/** Levels and tiles of a tree at most: beyond them it is taken to have no end. */
const MOST_LEVELS = 128;
export const MOST_TILES = 2_000_000;
/** Degrees from the middle to the farthest place, and of the middle from the equator, on one map. */
const [MOST_DEGREES, MOST_LATITUDE] = [25, 85];

/* eslint-disable @typescript-eslint/no-explicit-any */
type Json = any;

/** A node of the tree: what it covers, what it holds, and what has become of that. */
export class Tile {
  readonly children: Tile[] = [];
  /** "empty": there is nothing to draw in it, as in a tileset that it names. */
  state: "none" | "loading" | "ready" | "empty" | "failed" = "none";
  /** The round in which it was last of use, and what it takes in memory. */
  used = 0;
  bytes = 0;

  constructor(
    readonly parent: Tile | null,
    /** The tileset in which it stands, for it and its contents are named from there. */
    readonly home: string,
    readonly transform: Matrix,
    /** How far its content is from the true surface, metres. */
    readonly error: number,
    /** Whether its children stand in its place; else they are added to it. */
    readonly isReplaced: boolean,
    /** Corners of the box around it and all below, on the page. */
    readonly low: Vector,
    readonly high: Vector,
    /** Paths of its contents from the folder of the whole. */
    readonly contents: readonly string[],
    readonly depth: number,
  ) {}
}

export interface Head {
  json: Json;
  crs: string;
  notes: string[];
}

/** Check what is said of the whole. */
export function readHead(text: string, name: string): Head {
  let json: Json;
  try {
    json = JSON.parse(text);
  } catch {
    throw new TilesetError(`${name} is no tileset: it is not JSON.`);
  }
  const version: unknown = json?.asset?.version;
  if (version === "2.0" && json.root === undefined && (json.meshes ?? json.nodes ?? json.scenes) !== undefined)
    throw new TilesetError(`${name} is glTF in JSON: contents in GLB and b3dm are shown.`);
  if (typeof version !== "string" || typeof json.root !== "object" || json.root === null)
    throw new TilesetError(`${name} is no tileset of 3D Tiles: it has no 'asset' with a version, or no 'root'.`);
  if (!VERSIONS.includes(version))
    throw new TilesetError(`${name} is 3D Tiles ${quote(version)}: ${VERSIONS.join(" and ")} are read.`);
  for (const one of asList(json.extensionsRequired))
    if (!KNOWN_EXTENSIONS.includes(String(one)))
      throw new TilesetError(`${name} needs the extension ${quote(String(one))}, which is not read.`);
  const extras = json.asset.extras ?? {};
  const notes = asList(extras.notes).filter((one): one is string => typeof one === "string");
  return { json, notes, crs: typeof extras.crs === "string" ? extras.crs : "" };
}

function asList(value: unknown): unknown[] {
  return Array.isArray(value) ? value : [];
}

/** Choose how a tileset is laid on the page: by the middle of its root. */
export function chooseMapping({ json }: Head, name: string): Mapping {
  const { root } = json;
  const volume = root.boundingVolume ?? {};
  if (volume.region !== undefined) {
    const [west, south, east, north, low, high] = asNumbers(volume.region, 6, `${name}: root`).map((one, k) => (k < 4 ? one / RADIANS : one));
    const middle: Vector = [(west + (east < west ? east + 360 : east)) / 2, (south + north) / 2, (low + high) / 2];
    return requireMap(Mapping.around(middle), root, name);
  }
  const corners = listCorners(volume, asMatrix(root.transform, `${name}: root`), `${name}: root`);
  const middle = corners[Math.floor(corners.length / 2)];
  return requireMap(new Mapping(middle, isOnGlobe(middle)), root, name);
}

function requireMap(mapping: Mapping, root: Json, name: string): Mapping {
  if (!mapping.isGlobe) return mapping;
  const [low, high] = findBox(root.boundingVolume, asMatrix(root.transform, name), mapping, name);
  const reach = [0, 1].map((k) => Math.max(-low[k], high[k]) / mapping.scale[k]);
  if (Math.abs(mapping.origin[1]) > MOST_LATITUDE || Math.max(...reach) > MOST_DEGREES)
    throw new TilesetError(`${name} reaches over more of the globe than one map shows: ${MOST_DEGREES} degrees from its middle at most, and not at the poles.`);
  return mapping;
}

function asNumbers(value: unknown, count: number, where: string): number[] {
  if (!Array.isArray(value) || value.length !== count || !value.every((one) => Number.isFinite(one)))
    throw new TilesetError(`${where} has a volume or a transform that is not ${count} numbers.`);
  return value as number[];
}

function asMatrix(value: unknown, where: string): Matrix {
  return value === undefined ? IDENTITY : asNumbers(value, 16, where);
}

/** Return 27 places of a box or of the box around a sphere, the 14th in its middle. */
function listCorners(volume: Json, matrix: Matrix, where: string): Vector[] {
  let [middle, axes]: [number[], Vector[]] = [[], []];
  if (volume?.box !== undefined) {
    const box = asNumbers(volume.box, 12, where);
    middle = box.slice(0, 3);
    axes = [0, 1, 2].map((k) => box.slice(3 + 3 * k, 6 + 3 * k) as Vector);
  } else if (volume?.sphere !== undefined) {
    const [x, y, z, radius] = asNumbers(volume.sphere, 4, where);
    middle = [x, y, z];
    axes = [[radius, 0, 0], [0, radius, 0], [0, 0, radius]];
  } else throw new TilesetError(`${where} has no box, sphere or region around it.`);
  const corners: Vector[] = [];
  for (const a of [-1, 0, 1])
    for (const b of [-1, 0, 1])
      for (const c of [-1, 0, 1])
        corners.push(transform(matrix, [0, 1, 2].map((k) => middle[k] + a * axes[0][k] + b * axes[1][k] + c * axes[2][k]) as Vector));
  return corners;
}

/** Return the box on the page that holds a bounding volume. */
function findBox(volume: Json, matrix: Matrix, mapping: Mapping, where: string): [Vector, Vector] {
  const [low, high]: [Vector, Vector] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  const take = (place: Vector): void => place.forEach((value, k) => {
    low[k] = Math.min(low[k], value);
    high[k] = Math.max(high[k], value);
  });
  if (volume?.region !== undefined) {
    if (!mapping.isGlobe) throw new TilesetError(`${where} has a region of the globe, and the tileset does not lie on it.`);
    const [west, south, east, north, bottom, top] = asNumbers(volume.region, 6, where);
    take(mapping.placeGeodetic(west / RADIANS, south / RADIANS, bottom));
    take(mapping.placeGeodetic(east / RADIANS, north / RADIANS, top));
    return [low, high];
  }
  const corners = listCorners(volume, matrix, where);
  for (const corner of corners) take(mapping.place(corner));
  if (mapping.isGlobe) {
    // Between its corners a box may be so much farther out, or nearer to the middle of the Earth.
    const width = Math.hypot(...[0, 1, 2].map((k) => corners[0][k] - corners[26][k]));
    const bulge = (width * width) / (8 * 6_300_000);
    for (let k = 0; k < 3; k += 1) {
      low[k] -= bulge;
      high[k] += bulge;
    }
  }
  return [low, high];
}

/** Make the tiles of a tileset; of one inside another the root is a child of the tile that names it. */
export function makeTiles({ json }: Head, name: string, mapping: Mapping, above: Tile | null): Tile {
  let made: Tile | null = null;
  let count = 0;
  const stack: [Json, Tile | null, string][] = [[json.root, above, `${name}: root`]];
  while (stack.length > 0) {
    const [entry, parent, where] = stack.pop()!;
    const tile = makeTile(entry, parent, name, mapping, where);
    count += 1;
    if (tile.depth > MOST_LEVELS || count > MOST_TILES)
      throw new TilesetError(`${name} has more than ${MOST_LEVELS} levels or ${MOST_TILES} tiles.`);
    if (made === null) made = tile;
    else parent!.children.push(tile);
    const children = asList(entry.children);
    for (let k = children.length - 1; k >= 0; k -= 1) stack.push([children[k], tile, `${where}.children[${k}]`]);
  }
  above?.children.push(made!);
  return made!;
}

function makeTile(entry: Json, parent: Tile | null, name: string, mapping: Mapping, where: string): Tile {
  if (typeof entry !== "object" || entry === null) throw new TilesetError(`${where} is no tile.`);
  if ((entry.implicitTiling ?? entry.extensions?.["3DTILES_implicit_tiling"]) !== undefined)
    throw new TilesetError(`${where} has implicit tiling, which is not read: write the tileset with its tiles named.`);
  const error: unknown = entry.geometricError;
  if (typeof error !== "number" || !(error >= 0)) throw new TilesetError(`${where} has no 'geometricError' of 0 or more.`);
  const matrix = multiply(parent?.transform ?? IDENTITY, asMatrix(entry.transform, where));
  const [low, high] = findBox(entry.boundingVolume, matrix, mapping, where);
  const given = [entry.content, ...asList(entry.contents)].filter((one: Json) => one !== undefined && one !== null);
  const contents = given.map((one: Json) => {
    const uri: unknown = one.uri ?? one.url;
    if (typeof uri !== "string") throw new TilesetError(`${where} has a content without a 'uri'.`);
    return resolve(name, uri);
  });
  const refine: unknown = entry.refine;
  const isReplaced = typeof refine === "string" ? refine.toUpperCase() !== "ADD" : (parent?.isReplaced ?? true);
  return new Tile(parent, name, matrix, error, isReplaced, low, high, contents, (parent?.depth ?? -1) + 1);
}
