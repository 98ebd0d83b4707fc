// Reads a table, triangulates its points in WebAssembly, and writes files; runs in a worker.
"use strict";

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/;
const NAMES = [["x", "y", "z"], ["easting", "northing", "elevation"]];
const DELIMITERS = { ",": "comma", ";": "semicolon", "\t": "tab" };
let core = null;

class Refused extends Error {}

// ---------------------------------------------------------------- the table

// Returns rows of x, y, z one after the other, the line of each, and what is to be told.
function readTable(text) {
  const lines = text.replace(/^\uFEFF/, "").split(/\r\n|\n|\r/);
  const first = lines.findIndex((line) => line.trim() !== "");
  if (first < 0) throw new Refused("The file is empty.");
  const split = chooseSplit(lines[first]);
  const head = split(lines[first]);
  const isPlain = head.every((word) => NUMBER.test(word));
  const { places, notes } = isPlain ? placePlain(head) : placeNamed(head, first + 1);
  const rows = [], numbers = [];
  for (let k = isPlain ? first : first + 1; k < lines.length; k++) {
    if (lines[k].trim() === "") continue;
    const words = split(lines[k]);
    if (words.length !== head.length) {
      throw new Refused(`Line ${k + 1} has ${words.length} columns, and line ${first + 1} ${head.length}.`);
    }
    for (const place of places) rows.push(readNumber(words[place], k + 1));
    numbers.push(k + 1);
  }
  return { rows: Float64Array.from(rows), numbers, notes };
}

function chooseSplit(line) {
  const found = Object.keys(DELIMITERS).filter((one) => line.includes(one));
  if (found.length > 1) {
    const words = found.map((one) => DELIMITERS[one]).join(" and ");
    throw new Refused(`The first line holds ${words}: which of them divides columns cannot be told. ` +
      "Decimal commas are not read.");
  }
  const unquote = (word) => word.trim().replace(/^"(.*)"$/, "$1").trim();
  if (found.length === 0) return (one) => one.trim().split(/\s+/).map(unquote);
  return (one) => one.split(found[0]).map(unquote);
}

function placePlain(head) {
  if (head.length !== 3) {
    throw new Refused(`The file has no names of columns, and ${head.length} columns: ` +
      "without names there must be three, x, y, z.");
  }
  return { places: [0, 1, 2], notes: ["No names of columns: taken as x (easting), y (northing), z, in this order."] };
}

function placeNamed(head, line) {
  const names = head.map((word) => word.toLowerCase());
  const found = NAMES.filter((wanted) => wanted.every((name) => names.includes(name)));
  const some = names.map((name) => (name === "" ? "(none)" : name)).join(", ").slice(0, 200);
  if (found.length !== 1) {
    throw new Refused(`The columns in line ${line} are ${some}. They must be named x, y, z or easting, ` +
      "northing, elevation; the program tinsmith reads other names.");
  }
  const twice = found[0].filter((name) => names.indexOf(name) !== names.lastIndexOf(name));
  if (twice.length > 0) throw new Refused(`There are two columns '${twice[0]}'.`);
  const others = names.filter((name) => !found[0].includes(name));
  const notes = [`Columns ${found[0].join(", ")}.`];
  if (others.length > 0) notes.push(`Not read: ${others.join(", ").slice(0, 200)}.`);
  return { places: found[0].map((name) => names.indexOf(name)), notes };
}

function readNumber(word, line) {
  const value = NUMBER.test(word) ? Number(word) : NaN;
  if (!Number.isFinite(value)) throw new Refused(`Line ${line}: '${word.slice(0, 40)}' is no number.`);
  return value;
}

// ---------------------------------------------------------------- the triangulation

// WebAssembly of C++ asks for these; none is needed for a result.
function makeImports() {
  const nothing = () => 0;
  const stop = () => { throw new Error("the triangulation ended"); };
  const system = { proc_exit: stop, clock_time_get: nothing, fd_write: nothing, fd_close: nothing,
    fd_seek: nothing, environ_get: nothing, environ_sizes_get: nothing };
  return { env: { emscripten_notify_memory_growth: nothing }, wasi_snapshot_preview1: system };
}

async function load(bytes) {
  const { instance } = await WebAssembly.instantiate(bytes, makeImports());
  instance.exports._initialize();
  return instance.exports;
}

// Returns points, 3 a vertex, and triangles, 3 vertices each, as the program tinsmith numbers them.
function triangulate(rows, numbers) {
  const count = rows.length / 3;
  if (count < 3) throw new Refused(`A TIN needs three points, and there are ${count}.`);
  const at = core.allocate_rows(count);
  if (at === 0) throw new Refused(`There is no memory for ${count} points.`);
  try {
    new Float64Array(core.memory.buffer, at, rows.length).set(rows);
    if (core.clean_rows(at, count) === 0) {
      throw new Refused("A coordinate is beyond the range in which triangulation is exact.");
    }
    const size = core.triangulate(at, count);
    if (size === 0) throw new Refused("All points lie in one line: they have no triangle.");
    const clean = new Float64Array(core.memory.buffer, at, rows.length).slice();
    const corners = new Int32Array(core.memory.buffer, core.corners(), 3 * size).slice();
    return { ...keepFirst(clean, numbers), triangles: corners };
  } finally {
    core.free_rows(at);
  }
}

// Leaves out rows that are there twice; the core numbers vertices without them.
function keepFirst(rows, numbers) {
  const start = core.kept_rows();
  if (start === 0) return { points: rows, merged: 0 };
  const kept = new Int32Array(core.memory.buffer, start, rows.length / 3);
  const points = [];
  for (let k = 0; k < kept.length; k++) {
    const first = kept[k];
    if (first === k) points.push(rows[3 * k], rows[3 * k + 1], rows[3 * k + 2]);
    else if (rows[3 * k + 2] !== rows[3 * first + 2]) {
      throw new Refused(`Lines ${numbers[first]} and ${numbers[k]} are at one place with the elevations ` +
        `${rows[3 * first + 2]} and ${rows[3 * k + 2]}: the program tinsmith offers which to take.`);
    }
  }
  return { points: Float64Array.from(points), merged: kept.length - points.length / 3 };
}

// ---------------------------------------------------------------- files

// PLY as the program tinsmith writes it: binary, coordinates in doubles.
function writePly(points, triangles) {
  const vertices = points.length / 3, faces = triangles.length / 3;
  const header = new TextEncoder().encode(["ply", "format binary_little_endian 1.0",
    `element vertex ${vertices}`, "property double x", "property double y", "property double z",
    `element face ${faces}`, "property list uchar int vertex_indices", "end_header", ""].join("\n"));
  const content = new DataView(new ArrayBuffer(header.length + 24 * vertices + 13 * faces));
  new Uint8Array(content.buffer).set(header);
  let at = header.length;
  for (const value of points) { content.setFloat64(at, value, true); at += 8; }
  for (let k = 0; k < triangles.length; k += 3) {
    content.setUint8(at, 3);
    for (let c = 0; c < 3; c++) content.setInt32(at + 1 + 4 * c, triangles[k + c], true);
    at += 13;
  }
  return content.buffer;
}

function writeObj(points, triangles) {
  const lines = [];
  for (let k = 0; k < points.length; k += 3) lines.push(`v ${points[k]} ${points[k + 1]} ${points[k + 2]}`);
  for (let k = 0; k < triangles.length; k += 3) {
    lines.push(`f ${triangles[k] + 1} ${triangles[k + 1] + 1} ${triangles[k + 2] + 1}`);
  }
  return new TextEncoder().encode(lines.join("\n") + "\n").buffer;
}

// ---------------------------------------------------------------- messages

let made = null;

async function answer({ wasm, table, format }) {
  if (wasm) core = await load(wasm);
  if (format) return { file: (format === "ply" ? writePly : writeObj)(made.points, made.triangles) };
  if (!table) return {};
  let text;
  try {
    text = new TextDecoder("utf-8", { fatal: true }).decode(table);
  } catch {
    throw new Refused("The file is no text in UTF-8.");
  }
  const { rows, numbers, notes } = readTable(text);
  made = triangulate(rows, numbers);
  if (made.merged > 0) notes.push(`Rows that were there twice: ${made.merged}.`);
  return { points: made.points, triangles: made.triangles, notes };
}

self.onmessage = async ({ data }) => {
  try {
    self.postMessage({ id: data.id, ...(await answer(data)) });
  } catch (error) {
    const isOurs = error instanceof Refused;
    const words = isOurs ? error.message : `The triangulation failed (${error.message}): load the page anew.`;
    self.postMessage({ id: data.id, error: words });
  }
};
