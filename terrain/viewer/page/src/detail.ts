/** Fewer triangles while the view moves, where all of them cannot be drawn fast enough. */

import type { Surface } from "./surface";

/** Triangles that even a processor without a graphics card draws while the view moves. */
const MOST_WHILE_MOVING = 120_000;

/** Return triangles between one vertex of each square cell: clustering of vertices after Rossignac
 *  and Borrel, "Multi-resolution 3D approximations" (1993). Null where there are few already. */
export function simplify(surface: Surface): Uint32Array | null {
  const { triangles, positions, low, high, triangleCount } = surface;
  if (triangleCount <= MOST_WHILE_MOVING) return null;
  const [width, height] = [high[0] - low[0], high[1] - low[1]];
  // Of n cells with a vertex come about 2 n triangles.
  const cell = Math.sqrt((2 * width * height) / MOST_WHILE_MOVING);
  const columns = Math.floor(width / cell) + 1;
  const rows = Math.floor(height / cell) + 1;
  const chosen = new Int32Array(columns * rows).fill(-1);
  const nearest = new Uint32Array(positions.length / 3);
  for (let k = 0; k < nearest.length; k += 1) {
    const column = Math.floor((positions[3 * k] - low[0]) / cell);
    const row = Math.floor((positions[3 * k + 1] - low[1]) / cell);
    const at = row * columns + column;
    if (chosen[at] < 0) chosen[at] = k;
    nearest[k] = chosen[at];
  }
  const kept = new Uint32Array(triangles.length);
  let count = 0;
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [nearest[triangles[k]], nearest[triangles[k + 1]], nearest[triangles[k + 2]]];
    if (a === b || b === c || c === a) continue;
    kept[count] = a;
    kept[count + 1] = b;
    kept[count + 2] = c;
    count += 3;
  }
  return kept.slice(0, count);
}

/** Milliseconds from which a picture is slow, up to which it follows the one before, and after which
 *  the view is at rest. */
const SLOW = 90;
const MOST_SLOW = 5000;
const QUIET = 250;

/** Tells whether pictures follow each other too slowly: then a coarse one is drawn while the view
 *  moves, and a fine one as soon as it rests. */
export class Pace {
  isCoarse = false;
  private last = -Infinity;
  private slow = 0;
  private timer = 0;

  constructor(private readonly rest: () => void) {}

  /** Note the start of a picture, at a time in milliseconds. */
  note(now: number): void {
    const since = now - this.last;
    this.last = now;
    // A long wait is a rest, no slow picture.
    const follows = since < MOST_SLOW;
    if (follows) this.slow = since > SLOW ? this.slow + 1 : 0;
    if (this.slow >= 2) this.isCoarse = true;
    if (!this.isCoarse) return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      this.isCoarse = false;
      this.slow = 1;
      this.last = -Infinity;
      this.rest();
    }, Math.max(QUIET, follows ? 2 * since : 0));
  }
}
