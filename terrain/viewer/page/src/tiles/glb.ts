/** Reads the triangles of GLB (glTF 2.0), by itself or in a b3dm of 3D Tiles 1.0. */

import type { Vector } from "../surface";
import { IDENTITY, type Matrix, multiply, transform } from "./mapping";
import { TilesetError } from "./source";

/** Triangles of a content, in the coordinates of its tile: Z up, doubles. */
export interface Part {
  positions: Float64Array;
  triangles: Uint32Array;
  /** Red, green and blue of each vertex in linear light, 0 to 1. */
  colors: Float32Array | null;
}

const [GLTF, B3DM] = [0x46546c67, 0x6d643362];
/** Contents of 3D Tiles that hold no triangles, or not by themselves. */
const OTHERS: Record<number, string> = {
  0x73746e70: "a cloud of points (pnts)",
  0x6d643369: "models put at several places (i3dm)",
  0x74706d63: "a composite of several contents (cmpt)",
  0x74627573: "a subtree of implicit tiling",
};
const [JSON_CHUNK, BINARY_CHUNK] = [0x4e4f534a, 0x004e4942];
const B3DM_HEADER = 28;
const [TRIANGLES, STRIP, FAN] = [4, 5, 6];
/** glTF has Y up, tiles have Z up. */
const Z_UP: Matrix = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1];
const ARRAYS = {
  5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array,
} as const;
const WIDTHS: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
/** Extensions that change nothing about where triangles are; colours of materials are not shown. */
const HARMLESS = /^(KHR_mesh_quantization|KHR_materials_\w+|KHR_texture_\w+|EXT_texture_\w+|CESIUM_RTC|EXT_structural_metadata|EXT_mesh_features|KHR_xmp\w*)$/;
const COMPRESSED: Record<string, string> = {
  KHR_draco_mesh_compression: "Draco", EXT_meshopt_compression: "meshopt", KHR_meshopt_compression: "meshopt",
};
const MOST_NODES_DEEP = 128;

/* eslint-disable @typescript-eslint/no-explicit-any */
type Json = any;

/** Read a content; `name` is that of its file. */
export function readGlb(bytes: ArrayBuffer, name: string): Part[] {
  const view = new DataView(bytes);
  const magic = bytes.byteLength >= 12 ? view.getUint32(0, true) : 0;
  if (magic === B3DM) return readB3dm(bytes, view, name);
  if (magic !== GLTF) throw new TilesetError(`${name} is ${OTHERS[magic] ?? "no GLB"}: contents in GLB and b3dm are shown.`);
  if (view.getUint32(4, true) !== 2) throw new TilesetError(`${name} is glTF ${view.getUint32(4, true)}: 2 is read.`);
  const { document, binary } = splitChunks(bytes, view, name);
  return new Document(document, binary, name).read();
}

function readB3dm(bytes: ArrayBuffer, view: DataView, name: string): Part[] {
  const lengths = [12, 16, 20, 24].map((at) => (at + 4 <= bytes.byteLength ? view.getUint32(at, true) : NaN));
  const start = B3DM_HEADER + lengths.reduce((sum, one) => sum + one, 0);
  if (!(start < bytes.byteLength)) throw truncated(name);
  const parts = readGlb(bytes.slice(start), name);
  const table = new TextDecoder().decode(new Uint8Array(bytes, B3DM_HEADER, lengths[0]));
  const center = lengths[0] > 0 ? parseJson(table, name).RTC_CENTER : undefined;
  if (center === undefined) return parts;
  shift(parts, center, name);
  return parts;
}

function shift(parts: Part[], center: unknown, name: string): void {
  if (!Array.isArray(center) || center.length !== 3 || !center.every(Number.isFinite))
    throw new TilesetError(`${name} has a centre that is not three numbers.`);
  for (const { positions } of parts)
    for (let i = 0; i < positions.length; i += 1) positions[i] += center[i % 3];
}

function splitChunks(bytes: ArrayBuffer, view: DataView, name: string): { document: Json; binary: Uint8Array } {
  const length = view.getUint32(8, true);
  if (length > bytes.byteLength) throw truncated(name);
  let document: Json = null;
  let binary = new Uint8Array();
  for (let at = 12; at + 8 <= length; ) {
    const [size, kind] = [view.getUint32(at, true), view.getUint32(at + 4, true)];
    if (at + 8 + size > length) throw truncated(name);
    const chunk = new Uint8Array(bytes, at + 8, size);
    if (kind === JSON_CHUNK) document ??= parseJson(new TextDecoder().decode(chunk), name);
    else if (kind === BINARY_CHUNK && binary.length === 0) binary = chunk;
    at += 8 + size;
  }
  if (document === null || typeof document !== "object") throw new TilesetError(`${name} is damaged: it has no JSON.`);
  return { document, binary };
}

function parseJson(text: string, name: string): Json {
  try {
    return JSON.parse(text) as Json;
  } catch {
    throw new TilesetError(`${name} is damaged: its JSON cannot be read.`);
  }
}

function truncated(name: string): TilesetError {
  return new TilesetError(`${name} is damaged: it ends too early.`);
}

/** The JSON of a GLB, and what it names. */
class Document {
  constructor(
    private readonly json: Json,
    private readonly binary: Uint8Array,
    private readonly name: string,
  ) {}

  read(): Part[] {
    const { json, name } = this;
    for (const one of json.extensionsRequired ?? []) {
      if (one in COMPRESSED)
        throw new TilesetError(`${name} is compressed by ${COMPRESSED[one]}, which is not read: write the tileset without it.`);
      if (!HARMLESS.test(one)) throw new TilesetError(`${name} needs the extension ${one}, which is not read.`);
    }
    const parts: Part[] = [];
    const scene = json.scenes?.[json.scene ?? 0];
    const stack: [number, Matrix, number][] = (scene?.nodes ?? []).map((node: number) => [node, Z_UP, 0]);
    while (stack.length > 0) {
      const [number, above, depth] = stack.pop()!;
      const node = json.nodes?.[number];
      if (node === undefined || depth > MOST_NODES_DEEP) throw this.damaged(`node ${number}`);
      const matrix = multiply(above, this.matrixOf(node));
      if (node.mesh !== undefined) this.readMesh(node.mesh, matrix, parts);
      for (const child of node.children ?? []) stack.push([child, matrix, depth + 1]);
    }
    const center = json.extensions?.CESIUM_RTC?.center;
    if (center !== undefined) shift(parts, center, name);
    return parts;
  }

  private damaged(what: string): TilesetError {
    return new TilesetError(`${this.name} is damaged: its ${what} cannot be read.`);
  }

  private matrixOf(node: Json): Matrix {
    const numbers = (value: Json, count: number, plain: Matrix): Matrix => {
      if (value === undefined) return plain;
      if (!Array.isArray(value) || value.length !== count || !value.every(Number.isFinite)) throw this.damaged("transform");
      return value;
    };
    if (node.matrix !== undefined) return numbers(node.matrix, 16, IDENTITY);
    const [x, y, z, w] = numbers(node.rotation, 4, [0, 0, 0, 1]);
    const [a, b, c] = numbers(node.scale, 3, [1, 1, 1]);
    const [u, v, t] = numbers(node.translation, 3, [0, 0, 0]);
    return [
      a * (1 - 2 * (y * y + z * z)), a * 2 * (x * y + z * w), a * 2 * (x * z - y * w), 0,
      b * 2 * (x * y - z * w), b * (1 - 2 * (x * x + z * z)), b * 2 * (y * z + x * w), 0,
      c * 2 * (x * z + y * w), c * 2 * (y * z - x * w), c * (1 - 2 * (x * x + y * y)), 0,
      u, v, t, 1,
    ];
  }

  private readMesh(number: number, matrix: Matrix, parts: Part[]): void {
    const primitives = this.json.meshes?.[number]?.primitives;
    if (!Array.isArray(primitives)) throw this.damaged(`mesh ${number}`);
    for (const primitive of primitives) {
      const mode = primitive.mode ?? TRIANGLES;
      for (const one of Object.keys(primitive.extensions ?? {}))
        if (one in COMPRESSED)
          throw new TilesetError(`${this.name} is compressed by ${COMPRESSED[one]}, which is not read: write the tileset without it.`);
      if (mode < TRIANGLES || primitive.attributes?.POSITION === undefined) continue;
      const local = this.accessor(primitive.attributes.POSITION, 3);
      const positions = new Float64Array(local.length);
      for (let i = 0; i < local.length; i += 3)
        positions.set(transform(matrix, [local[i], local[i + 1], local[i + 2]] as Vector), i);
      if (!positions.every(Number.isFinite)) throw new TilesetError(`${this.name} is damaged: it has coordinates that are no numbers.`);
      const triangles = this.trianglesOf(primitive, mode, positions.length / 3);
      parts.push({ positions, triangles, colors: this.colorsOf(primitive, positions.length / 3) });
    }
  }

  private colorsOf(primitive: Json, count: number): Float32Array | null {
    const number = primitive.attributes.COLOR_0;
    if (number === undefined) return null;
    const width = this.json.accessors?.[number]?.type === "VEC4" ? 4 : 3;
    const given = this.accessor(number, width);
    if (given.length !== width * count) throw this.damaged("colours");
    if (width === 3) return Float32Array.from(given);
    return Float32Array.from({ length: 3 * count }, (_, i) => given[4 * Math.floor(i / 3) + (i % 3)]);
  }

  private trianglesOf(primitive: Json, mode: number, count: number): Uint32Array {
    const given = primitive.indices === undefined
      ? Uint32Array.from({ length: count }, (_, k) => k)
      : Uint32Array.from(this.accessor(primitive.indices, 1));
    for (const one of given) if (one >= count) throw this.damaged("triangles");
    if (mode === TRIANGLES) return given.length % 3 === 0 ? given : given.slice(0, given.length - (given.length % 3));
    const triangles = new Uint32Array(3 * Math.max(0, given.length - 2));
    for (let k = 0; k + 2 < given.length; k += 1) {
      const turned = mode === STRIP && k % 2 === 1;
      triangles.set(mode === FAN ? [given[0], given[k + 1], given[k + 2]]
        : turned ? [given[k + 1], given[k], given[k + 2]] : [given[k], given[k + 1], given[k + 2]], 3 * k);
    }
    return triangles;
  }

  /** Return the numbers of an accessor, whole ones as shares of one where it says so. */
  private accessor(number: number, width: number): ArrayLike<number> & Iterable<number> {
    const { json, name } = this;
    const accessor = json.accessors?.[number];
    const view = json.bufferViews?.[accessor?.bufferView];
    const kind = ARRAYS[accessor?.componentType as keyof typeof ARRAYS];
    if (accessor?.sparse !== undefined) throw new TilesetError(`${name} has sparse arrays, which are not read.`);
    if (view?.extensions !== undefined && Object.keys(view.extensions).some((one) => one in COMPRESSED))
      throw new TilesetError(`${name} is compressed by meshopt, which is not read: write the tileset without it.`);
    const count = accessor?.count;
    if (view === undefined || kind === undefined || WIDTHS[accessor.type] !== width || !Number.isSafeInteger(count) || count < 0)
      throw this.damaged(`accessor ${number}`);
    if (json.buffers?.[view.buffer]?.uri !== undefined || view.buffer !== 0)
      throw new TilesetError(`${name} keeps its numbers in another file, which is not read.`);
    const size = kind.BYTES_PER_ELEMENT;
    const stride = view.byteStride ?? width * size;
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const end = start + (count === 0 ? 0 : (count - 1) * stride + width * size);
    if (!Number.isSafeInteger(stride) || stride < width * size || !Number.isSafeInteger(start) || start < 0 || end > this.binary.length)
      throw truncated(name);
    const packed = new Uint8Array(count * width * size);
    const { binary } = this;
    if (stride === width * size) packed.set(binary.subarray(start, start + packed.length));
    else
      for (let k = 0; k < count; k += 1)
        packed.set(binary.subarray(start + k * stride, start + k * stride + width * size), k * width * size);
    const values = new kind(packed.buffer);
    if (accessor.normalized !== true || kind === Float32Array) return values;
    const most = 2 ** (8 * size - (kind === Int8Array || kind === Int16Array ? 1 : 0)) - 1;
    return Float64Array.from(values, (value) => Math.max(value / most, -1));
  }
}
