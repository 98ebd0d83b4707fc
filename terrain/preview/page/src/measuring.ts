/** Lengths, areas and profiles of what was picked. */

import type { Marked } from "./annotations";
import type { ProfilePoint } from "./surface";

export interface Measured {
  /** Seen from above, horizontal units. */
  length: number;
  /** Along the ground, horizontal units. */
  groundLength: number;
  /** From the first place to the last, units of elevation. */
  rise: number;
}

export function measureLine(marked: Marked[], elevationScale: number): Measured {
  let [length, groundLength] = [0, 0];
  for (let k = 0; k + 1 < marked.length; k += 1) {
    const [a, b] = [marked[k].hit, marked[k + 1].hit];
    length += Math.hypot(b.x - a.x, b.y - a.y);
    for (const piece of marked[k].model.surface.profile([a.x, a.y], [b.x, b.y]))
      for (let i = 0; i + 1 < piece.length; i += 1)
        groundLength += Math.hypot(
          piece[i + 1][0] - piece[i][0],
          (piece[i + 1][1] - piece[i][1]) * elevationScale,
        );
  }
  const rise = marked.length < 2 ? 0 : marked[marked.length - 1].hit.z - marked[0].hit.z;
  return { length, groundLength, rise };
}

/** Return the area of a polygon seen from above (the shoelace formula) and its perimeter. */
export function measureArea(marked: Marked[]): { area: number; perimeter: number } {
  let [area, perimeter] = [0, 0];
  const start = marked[0]?.hit;
  marked.forEach(({ hit: a }, k) => {
    const b = marked[(k + 1) % marked.length].hit;
    area += (a.x - start.x) * (b.y - start.y) - (b.x - start.x) * (a.y - start.y);
    perimeter += Math.hypot(b.x - a.x, b.y - a.y);
  });
  return { area: Math.abs(area) / 2, perimeter };
}

/** Return the profile of every surface along a line of places, distances summed. */
export function profileAlong(marked: Marked[], index: number, surfaces: Marked["model"][]): ProfilePoint[][] {
  const surface = surfaces[index].surface;
  const pieces: ProfilePoint[][] = [];
  let before = 0;
  for (let k = 0; k + 1 < marked.length; k += 1) {
    const [a, b] = [marked[k].hit, marked[k + 1].hit];
    for (const piece of surface.profile([a.x, a.y], [b.x, b.y]))
      pieces.push(piece.map(([distance, z]) => [before + distance, z]));
    before += Math.hypot(b.x - a.x, b.y - a.y);
  }
  return pieces;
}
