/** A plan of the first surface for browsers without WebGL: tinted, lit from the northwest. */

import type { Payload } from "./payload";
import type { Surface } from "./surface";

export function drawStill(
  canvas: HTMLCanvasElement,
  surface: Surface,
  payload: Payload,
  picture: ImageBitmap | null,
): void {
  const [width, height] = [surface.high[0] - surface.low[0], surface.high[1] - surface.low[1]];
  const scale = Math.min(canvas.width / width, canvas.height / height) * 0.94;
  const pen = canvas.getContext("2d");
  if (pen === null) return;
  const left = (canvas.width - width * scale) / 2;
  const bottom = canvas.height - (canvas.height - height * scale) / 2;
  const ramp = payload.ramps.elevation;
  const relief = surface.high[2] - surface.low[2] || 1;
  for (let t = 0; t < surface.triangleCount; t += 1) {
    const [a, b, c] = surface.corners(t);
    const place = ((a[2] + b[2] + c[2]) / 3 - surface.low[2]) / relief;
    pen.fillStyle = shade(ramp[Math.min(ramp.length - 1, Math.floor(place * ramp.length))], surface, t);
    pen.strokeStyle = pen.fillStyle;
    pen.beginPath();
    for (const [x, y] of [a, b, c])
      pen.lineTo(left + (x - surface.low[0]) * scale, bottom - (y - surface.low[1]) * scale);
    pen.closePath();
    pen.fill();
    pen.stroke();
  }
  if (picture === null) return;
  // Only where triangles have been drawn; a pixel of the picture is the unit of lengths.
  const [a, b, x, d, e, y] = payload.ortho!.place;
  const toPage = new DOMMatrix([scale, 0, 0, -scale, left - surface.low[0] * scale, bottom + surface.low[1] * scale]);
  const toPicture = new DOMMatrix([a, d, b, e, x, y]);
  pen.globalCompositeOperation = "source-atop";
  pen.setTransform(toPage.multiply(toPicture.inverse()).scale(1 / picture.width, 1 / picture.height));
  pen.drawImage(picture, 0, 0);
  pen.resetTransform();
}

function shade(color: string, surface: Surface, triangle: number): string {
  const [a, b, c] = surface.corners(triangle);
  const s = surface.elevationScale;
  const [u, v] = [
    [b[0] - a[0], b[1] - a[1], (b[2] - a[2]) * s],
    [c[0] - a[0], c[1] - a[1], (c[2] - a[2]) * s],
  ];
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const light = (-0.5 * n[0] + 0.5 * n[1] + Math.SQRT1_2 * n[2]) / (Math.hypot(...n) || 1);
  const factor = 0.42 + 0.58 * Math.min(Math.max(light, 0) / Math.SQRT1_2, 1.35);
  const value = parseInt(color.slice(1), 16);
  const part = (shift: number): number => Math.min(255, Math.round(((value >> shift) & 255) * factor));
  return `rgb(${part(16)} ${part(8)} ${part(0)})`;
}
