/** Packed numbers become typed arrays. */

import type { Packed, PackedLines } from "./payload";

export function decodeBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i += 1) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(text: string): Promise<Uint8Array> {
  const stream = new Blob([decodeBase64(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Join the planes of bytes into numbers and undo the zigzag coding, in which 0, -1, 1 are 0, 1, 2. */
async function decode(packed: Packed): Promise<Int32Array> {
  const count = packed.rows * packed.columns;
  const numbers = new Int32Array(count);
  if (count === 0 || packed.planes === 0) return numbers;
  const bytes = await inflate(packed.data);
  if (bytes.length !== count * packed.planes) throw new Error("the page's data is damaged");
  for (let plane = 0; plane < packed.planes; plane += 1) {
    const start = plane * count;
    const shift = 8 * plane;
    for (let i = 0; i < count; i += 1) numbers[i] |= bytes[start + i] << shift;
  }
  for (let i = 0; i < count; i += 1) numbers[i] = (numbers[i] >>> 1) ^ -(numbers[i] & 1);
  return numbers;
}

/** Return rows of which each is given as the difference from the row before. */
export async function unpackRows(packed: Packed): Promise<Int32Array> {
  const numbers = await decode(packed);
  for (let i = packed.columns; i < numbers.length; i += 1) numbers[i] += numbers[i - packed.columns];
  return numbers;
}

/** Return triangles: the first corner from the first corner before, the others from the first. */
export async function unpackTriangles(packed: Packed): Promise<Uint32Array> {
  const numbers = await decode(packed);
  let first = 0;
  for (let i = 0; i < numbers.length; i += 3) {
    first += numbers[i];
    numbers[i] = first;
    numbers[i + 1] += first;
    numbers[i + 2] += first;
  }
  return new Uint32Array(numbers.buffer);
}

export interface Lines {
  vertices: Int32Array;
  /** Line k has the vertices offsets[k] to offsets[k + 1]. */
  offsets: Int32Array;
}

export async function unpackLines(packed: PackedLines): Promise<Lines> {
  const vertices = await unpackRows(packed.vertices);
  const counts = await decode(packed.counts);
  const offsets = new Int32Array(counts.length + 1);
  for (let k = 0; k < counts.length; k += 1) offsets[k + 1] = offsets[k] + counts[k];
  return { vertices, offsets };
}
