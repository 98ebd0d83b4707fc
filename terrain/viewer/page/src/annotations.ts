/** What is written over the picture: labels of points, what is measured, scale bar, north arrow. */

import type { Model, TerrainScene } from "./scene";
import type { Hit } from "./surface";

export interface Marked {
  model: Model;
  hit: Hit;
}

const LABEL_CELL = [72, 16];
const MOST_LABELS = 400;

/** Draw the labels that have room, the nearest first. */
export function drawLabels(pen: CanvasRenderingContext2D, scene: TerrainScene, ink: string, halo: string): void {
  pen.font = "11px system-ui, sans-serif";
  pen.textBaseline = "middle";
  pen.lineWidth = 3;
  pen.strokeStyle = halo;
  pen.fillStyle = ink;
  const taken = new Set<string>();
  for (const model of scene.models) {
    const { labels } = model;
    if (labels === null || !labels.marks.visible || !model.group.visible) continue;
    for (const [x, y, text] of placeLabels(scene, labels.places, labels.texts, taken)) {
      pen.strokeText(text, x + 5, y - 5);
      pen.fillText(text, x + 5, y - 5);
    }
  }
}

function placeLabels(
  scene: TerrainScene,
  places: Float64Array,
  texts: string[],
  taken: Set<string>,
): [number, number, string][] {
  const { clientWidth: width, clientHeight: height } = scene.canvas;
  const seen: [number, number, number, string][] = [];
  texts.forEach((text, k) => {
    const at = scene.project(places[3 * k], places[3 * k + 1], places[3 * k + 2]);
    if (at === null || at[0] < 0 || at[1] < 0 || at[0] > width || at[1] > height) return;
    seen.push([at[2], at[0], at[1], text]);
  });
  seen.sort((a, b) => a[0] - b[0]);
  const placed: [number, number, string][] = [];
  for (const [, x, y, text] of seen) {
    const key = `${Math.round(x / LABEL_CELL[0])} ${Math.round(y / LABEL_CELL[1])}`;
    if (taken.has(key)) continue;
    taken.add(key);
    placed.push([x, y, text]);
    if (placed.length === MOST_LABELS) break;
  }
  return placed;
}

/** Draw the places that were picked and the line between them, along the ground. */
export function drawMeasured(
  pen: CanvasRenderingContext2D,
  scene: TerrainScene,
  marked: Marked[],
  closed: boolean,
  color: string,
): void {
  if (marked.length === 0) return;
  pen.strokeStyle = color;
  pen.fillStyle = color;
  pen.lineWidth = 2.5;
  const ring = closed && marked.length > 2 ? [...marked, marked[0]] : marked;
  for (let k = 0; k + 1 < ring.length; k += 1) drawAlong(pen, scene, ring[k], ring[k + 1]);
  drawPlaces(pen, scene, marked);
}

/** Draw the places that were picked on lines of the surface, and the way between them. */
export function drawRoute(
  pen: CanvasRenderingContext2D,
  scene: TerrainScene,
  marked: Marked[],
  path: Marked[],
  color: string,
): void {
  pen.strokeStyle = color;
  pen.fillStyle = color;
  pen.lineWidth = 4;
  pen.beginPath();
  let isDown = false;
  for (const { hit } of path) {
    const at = scene.project(hit.x, hit.y, hit.z);
    if (at !== null) pen[isDown ? "lineTo" : "moveTo"](at[0], at[1]);
    isDown = at !== null;
  }
  pen.stroke();
  drawPlaces(pen, scene, marked);
}

function drawPlaces(pen: CanvasRenderingContext2D, scene: TerrainScene, marked: Marked[]): void {
  for (const { hit } of marked) {
    const at = scene.project(hit.x, hit.y, hit.z);
    if (at === null) continue;
    pen.beginPath();
    pen.arc(at[0], at[1], 4.5, 0, 2 * Math.PI);
    pen.fill();
  }
}

/** Draw a cross in the middle of the view: where the keys read and mark. */
export function drawCross(pen: CanvasRenderingContext2D, view: HTMLElement, ink: string, halo: string): void {
  const [x, y] = [view.clientWidth / 2, view.clientHeight / 2];
  for (const [color, width] of [[halo, 4], [ink, 1.5]] as const) {
    pen.strokeStyle = color;
    pen.lineWidth = width;
    pen.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      pen.moveTo(x + 4 * dx, y + 4 * dy);
      pen.lineTo(x + 12 * dx, y + 12 * dy);
    }
    pen.stroke();
  }
}

function drawAlong(pen: CanvasRenderingContext2D, scene: TerrainScene, from: Marked, to: Marked): void {
  const [a, b] = [from.hit, to.hit];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const pieces = from.model.surface.profile([a.x, a.y], [b.x, b.y]);
  for (const piece of pieces) {
    pen.beginPath();
    piece.forEach(([distance, z], k) => {
      const share = distance / length;
      const at = scene.project(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), z);
      if (at !== null) pen[k === 0 ? "moveTo" : "lineTo"](at[0], at[1]);
    });
    pen.stroke();
  }
}

/** Return a round length (1, 2 or 5 times a power of ten) of at most so many pixels. */
export function chooseBar(unitsPerPixel: number, pixels: number): [length: number, pixels: number] {
  const most = unitsPerPixel * pixels;
  const power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((n) => n * power).find((n) => n <= most) ?? power;
  return [length, length / unitsPerPixel];
}

/** Draw the legend as it stands on the page: title, ramp and numbers. */
export function drawLegend(pen: CanvasRenderingContext2D, legend: HTMLElement, view: HTMLElement): void {
  const [width, left, top] = [208, view.clientWidth - 224, view.clientHeight - 52];
  pen.font = "14px system-ui, sans-serif";
  pen.fillText(legend.querySelector("figcaption")!.textContent ?? "", left, top, width);
  const colors = legend.querySelector<HTMLElement>("#ramp")!.dataset.colors!.split(" ");
  const ink = pen.fillStyle;
  colors.forEach((color, k) => {
    pen.fillStyle = color;
    pen.fillRect(left + (k * width) / colors.length, top + 8, width / colors.length + 0.5, 12);
  });
  pen.fillStyle = ink;
  pen.font = "12px system-ui, sans-serif";
  const ticks = [...legend.querySelectorAll("#ticks span")].map((one) => one.textContent ?? "");
  ticks.forEach((text, k) => {
    pen.textAlign = k === 0 ? "left" : k === ticks.length - 1 ? "right" : "center";
    pen.fillText(text, left + (k * width) / (ticks.length - 1), top + 34);
  });
  pen.textAlign = "left";
}

/** Draw the arrow of the page, turned to the north. */
export function drawNorth(pen: CanvasRenderingContext2D, x: number, y: number, heading: number): void {
  pen.save();
  pen.translate(x, y);
  pen.rotate((-heading * Math.PI) / 180);
  pen.fill(new Path2D("M0-17 6 8 0 4-6 8Z"));
  pen.textAlign = "center";
  pen.font = "600 12px system-ui, sans-serif";
  pen.fillText("N", 0, -20);
  pen.restore();
}
