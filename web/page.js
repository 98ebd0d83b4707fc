// The page: takes a dropped file, shows the TIN, and offers files of it.
"use strict";

const TINTS = [[47, 111, 94], [143, 181, 115], [230, 215, 154], [185, 138, 86], [244, 241, 236]];
const LIGHT = [-0.5, 0.5, 0.70710678];
const element = (name) => document.getElementById(name);
const code = new Blob([element("worker").textContent], { type: "text/javascript" });
const worker = new Worker(URL.createObjectURL(code));
const waiting = new Map();
let asked = 0;
let fileName = "tin";

worker.onmessage = ({ data }) => {
  waiting.get(data.id)(data);
  waiting.delete(data.id);
};

function ask(question) {
  return new Promise((resolve) => {
    waiting.set(++asked, resolve);
    worker.postMessage({ id: asked, ...question });
  });
}

// Builds the TIN of a table; resolves to points, triangles and notes, or to an error.
async function build(table, name) {
  element("told").textContent = "Triangulating ...";
  const found = await ask({ table });
  for (const one of document.querySelectorAll("button")) one.disabled = Boolean(found.error);
  element("told").className = found.error ? "error" : "";
  element("told").textContent = found.error ?? describe(found);
  if (!found.error) {
    fileName = name.replace(/\.[^.]*$/, "") || "tin";
    draw(found.points, found.triangles);
  } else {
    const canvas = element("map");
    canvas.ariaLabel = "Map of the TIN, which is empty: the file cannot be read";
    canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
  }
  return found;
}

function describe({ points, triangles, notes }) {
  const words = (count) => count.toLocaleString("en");
  return [`${words(points.length / 3)} vertices, ${words(triangles.length / 3)} triangles.`, ...notes].join(" ");
}

function measure(points) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < points.length; k++) {
    low[k % 3] = Math.min(low[k % 3], points[k]);
    high[k % 3] = Math.max(high[k % 3], points[k]);
  }
  return { low, high };
}

function mix(share, light) {
  const place = share * (TINTS.length - 1);
  const k = Math.min(Math.floor(place), TINTS.length - 2);
  const tint = TINTS[k].map((a, c) => Math.round((a + (place - k) * (TINTS[k + 1][c] - a)) * light));
  return `rgb(${tint.join()})`;
}

function shade(a, b, c) {
  const u = b.map((v, k) => v - a[k]), w = c.map((v, k) => v - a[k]);
  const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
  const size = Math.hypot(...n) || 1;
  return 0.55 + 0.45 * Math.max(0, n.reduce((sum, v, k) => sum + (v / size) * LIGHT[k], 0)) / LIGHT[2];
}

// Draws triangles in tints of elevation, lit from the north-west; y is up.
function draw(points, triangles) {
  const canvas = element("map");
  const context = canvas.getContext("2d");
  const { low, high } = measure(points);
  canvas.ariaLabel = `Map of the TIN in tints of elevation, from ${low[2]} to ${high[2]}, north up`;
  const scale = Math.min(canvas.width / (high[0] - low[0]), canvas.height / (high[1] - low[1])) * 0.96;
  const left = (canvas.width - (high[0] - low[0]) * scale) / 2;
  const bottom = (canvas.height + (high[1] - low[1]) * scale) / 2;
  context.clearRect(0, 0, canvas.width, canvas.height);
  for (let k = 0; k < triangles.length; k += 3) {
    const corners = [0, 1, 2].map((c) => points.slice(3 * triangles[k + c], 3 * triangles[k + c] + 3));
    const [a, b, c] = corners.map((one) => [...one].map((v, axis) => v - low[axis]));
    const share = high[2] > low[2] ? (a[2] + b[2] + c[2]) / 3 / (high[2] - low[2]) : 0.5;
    context.fillStyle = context.strokeStyle = mix(Math.min(share, 1), Math.min(shade(a, b, c), 1));
    context.beginPath();
    for (const one of [a, b, c]) context.lineTo(left + one[0] * scale, bottom - one[1] * scale);
    context.closePath();
    context.fill();
    context.stroke();
  }
}

async function save(format) {
  const { file } = await ask({ format });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([file]));
  link.download = `${fileName}.${format}`;
  link.click();
  URL.revokeObjectURL(link.href);
}

async function take(file) {
  if (file) await build(await file.arrayBuffer(), file.name);
}

const core = Uint8Array.from(atob(element("core").textContent.trim()), (letter) => letter.charCodeAt(0));
document.ondragover = (event) => event.preventDefault();
document.ondrop = (event) => {
  event.preventDefault();
  take(event.dataTransfer.files[0]);
};
element("file").onchange = (event) => take(event.target.files[0]);
for (const format of ["ply", "obj"]) element(format).onclick = () => save(format);
window.tin = { ask, build, ready: ask({ wasm: core.buffer }) };
