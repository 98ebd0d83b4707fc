/** The profile as a drawing: distance to the right, elevation up, a line for each surface. */

import type { ProfilePoint } from "../surface";

export interface Curve {
  name: string;
  color: string;
  pieces: ProfilePoint[][];
}

const MARGIN = { left: 58, right: 14, top: 12, bottom: 34 };
const SVG = "http://www.w3.org/2000/svg";

/** Draw curves in so many pixels of width and height. */
export function drawProfile(
  curves: Curve[],
  units: { horizontal: string; elevation: string },
  size: [number, number],
  word = "elevation",
): SVGSVGElement {
  const svg = make("svg", { viewBox: `0 0 ${size[0]} ${size[1]}`, role: "img" }) as SVGSVGElement;
  const points = curves.flatMap((curve) => curve.pieces.flat());
  svg.setAttribute("aria-label", points.length === 0 ? "Profile without a surface" : "Profile");
  if (points.length === 0) return svg;
  const right = Math.max(...extent(points, 0)) || 1;
  let [low, high] = extent(points, 1);
  if (!(high > low)) [low, high] = [low - 0.5, high + 0.5];
  const x = (value: number): number =>
    MARGIN.left + (value / right) * (size[0] - MARGIN.left - MARGIN.right);
  const y = (value: number): number =>
    size[1] - MARGIN.bottom - ((value - low) / (high - low)) * (size[1] - MARGIN.top - MARGIN.bottom);
  for (const tick of chooseTicks(0, right, Math.max(2, Math.floor(size[0] / 90)))) addTick(svg, size, "x", x(tick), tick);
  for (const tick of chooseTicks(low, high, Math.max(2, Math.floor(size[1] / 38)))) addTick(svg, size, "y", y(tick), tick);
  for (const { color, pieces } of curves)
    for (const piece of pieces) {
      const path = piece.map(([d, z]) => `${x(d).toFixed(2)},${y(z).toFixed(2)}`).join(" ");
      svg.append(make("polyline", { points: path, class: "curve", stroke: color }));
    }
  const words = (values: [number, number], unit: string): string =>
    `${values.map((value) => Number(value.toPrecision(6))).join(" to ")} ${unit}`.trim();
  const reach = `distance ${words([0, right], units.horizontal)}, ${word} ${words([low, high], units.elevation)}`;
  svg.setAttribute("aria-label", `Profile of ${curves.map(({ name }) => name.slice(0, 80)).join(", ")}: ${reach}`);
  addText(svg, (MARGIN.left + size[0]) / 2, size[1] - 4, label("distance", units.horizontal));
  addText(svg, MARGIN.left, MARGIN.top - 2, label(word, units.elevation), "start");
  return svg;
}

function label(words: string, unit: string): string {
  return unit === "" ? words : `${words}, ${unit}`;
}

/** Return round numbers (steps of 1, 2 or 5 times a power of ten) inside a range. */
export function chooseTicks(low: number, high: number, most: number): number[] {
  const power = 10 ** Math.floor(Math.log10((high - low) / most));
  const step = [1, 2, 5, 10].map((n) => n * power).find((n) => (high - low) / n <= most) ?? power;
  const first = Math.ceil(low / step);
  const ticks: number[] = [];
  // Counted, for beyond 2^53 a number and the next one are the same.
  for (let k = 0; k <= most && (first + k) * step <= high; k += 1) ticks.push((first + k) * step);
  return ticks;
}

function extent(points: ProfilePoint[], axis: 0 | 1): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const point of points) {
    low = Math.min(low, point[axis]);
    high = Math.max(high, point[axis]);
  }
  return [low, high];
}

function addTick(svg: SVGSVGElement, size: [number, number], axis: "x" | "y", at: number, value: number): void {
  const text = String(Number(value.toPrecision(12)));
  if (axis === "x") {
    svg.append(make("line", { x1: at, x2: at, y1: MARGIN.top, y2: size[1] - MARGIN.bottom, class: "grid" }));
    addText(svg, at, size[1] - MARGIN.bottom + 13, text);
  } else {
    svg.append(make("line", { x1: MARGIN.left, x2: size[0] - MARGIN.right, y1: at, y2: at, class: "grid" }));
    addText(svg, MARGIN.left - 6, at + 3.5, text, "end");
  }
}

function addText(svg: SVGSVGElement, x: number, y: number, text: string, anchor = "middle"): void {
  const element = make("text", { x, y, "text-anchor": anchor });
  element.textContent = text;
  svg.append(element);
}

function make(name: string, attributes: Record<string, string | number>): SVGElement {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return element;
}
