/** Lengths, areas and profiles of what was picked. */

import type { Marked } from "../annotations";
import type { Factors } from "../ground";
import type { Hit, ProfilePoint } from "../surface";

type Ground = (y: number) => Factors;
type Plan = Pick<Hit, "x" | "y">;

export interface Measured {
  /** Seen from above, horizontal units. */
  length: number;
  /** The part of it that is on the surface. */
  covered: number;
  /** Along the ground, horizontal units; of that part. */
  groundLength: number;
  /** From the first place to the last, units of elevation. */
  rise: number;
}

/** Return the length of a segment, with the factors of its middle. */
export function measureSegment(a: Plan, b: Plan, ground: Ground): number {
  const [east, north] = ground((a.y + b.y) / 2);
  return Math.hypot(east * (b.x - a.x), north * (b.y - a.y));
}

/** Measure a line of places. If it runs along edges, the surface is straight between its places. */
export function measureLine(
  marked: Marked[],
  elevationScale: number,
  ground: Ground,
  isOnEdges = false,
): Measured {
  let [length, covered, groundLength] = [0, 0, 0];
  for (let k = 0; k + 1 < marked.length; k += 1) {
    const [a, b] = [marked[k].hit, marked[k + 1].hit];
    const onGround = measureSegment(a, b, ground);
    const plain = Math.hypot(b.x - a.x, b.y - a.y);
    const factor = onGround / (plain || 1);
    length += onGround;
    const pieces: ProfilePoint[][] = isOnEdges
      ? [[[0, a.z], [plain, b.z]]]
      : marked[k].model.surface.profile([a.x, a.y], [b.x, b.y]);
    for (const piece of pieces)
      for (let i = 0; i + 1 < piece.length; i += 1) {
        const along = factor * (piece[i + 1][0] - piece[i][0]);
        covered += along;
        groundLength += Math.hypot(along, (piece[i + 1][1] - piece[i][1]) * elevationScale);
      }
  }
  const rise = marked.length < 2 ? 0 : marked[marked.length - 1].hit.z - marked[0].hit.z;
  return { length, covered, groundLength, rise };
}

/** Return the area of a polygon seen from above (the shoelace formula) and its perimeter. */
export function measureArea(marked: Marked[], ground: Ground): { area: number; perimeter: number } {
  let [area, perimeter] = [0, 0];
  const start = marked[0]?.hit;
  marked.forEach(({ hit: a }, k) => {
    const b = marked[(k + 1) % marked.length].hit;
    const [east, north] = ground((a.y + b.y + start.y) / 3);
    area += east * north * ((a.x - start.x) * (b.y - start.y) - (b.x - start.x) * (a.y - start.y));
    perimeter += measureSegment(a, b, ground);
  });
  return { area: Math.abs(area) / 2, perimeter };
}

/** Whether two sides of a polygon cross, so that it has no area to tell. */
export function crossesItself(marked: Marked[]): boolean {
  const corners = marked.map(({ hit }) => hit);
  const count = corners.length;
  const side = (a: Hit, b: Hit, c: Hit): number =>
    Math.sign((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  for (let i = 0; i < count; i += 1)
    for (let j = i + 2; j < count; j += 1) {
      if (i === 0 && j === count - 1) continue;
      const [a, b, c, d] = [corners[i], corners[i + 1], corners[j], corners[(j + 1) % count]];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  return false;
}
