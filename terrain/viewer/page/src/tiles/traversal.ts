/** Which tiles are shown, and which are needed: coarse ones first, and no hole while finer ones come. */

import type { Tile } from "./tileset";

export interface Choice {
  /** Tiles whose contents are drawn. */
  shown: Tile[];
  /** Tiles whose contents are asked for, the most urgent first. */
  wanted: Tile[];
  /** Tiles in view, those above what is shown among them: not to be forgotten. */
  used: Tile[];
}

/** Choose from the root down, as "Traversal" in the 3D Tiles specification has it.
 *
 *  `measure` gives the error of a tile on the screen in pixels, or null out of view. A tile whose
 *  error is larger than `most` is replaced by its children, once all of them that are in view are
 *  there; until then it stays. */
export function choose(root: Tile, measure: (tile: Tile) => number | null, most: number): Choice {
  const shown: Tile[] = [];
  const used: Tile[] = [];
  const asked: [Tile, number][] = [];
  /** Show a tile, or what is below; return whether all of it that is in view is covered. As deep as
   *  a tileset may be. */
  const visit = (tile: Tile): boolean => {
    const error = measure(tile);
    if (error === null) return true;
    used.push(tile);
    const isEmpty = tile.contents.length === 0 || tile.state === "failed" || tile.state === "empty";
    if (!isEmpty && tile.state !== "ready") {
      asked.push([tile, error]);
      return false;
    }
    const refines = tile.children.length > 0 && (isEmpty || error > most);
    if (!tile.isReplaced && !isEmpty) {
      shown.push(tile);
      if (refines) tile.children.forEach(visit);
      return true;
    }
    if (!refines) {
      if (!isEmpty) shown.push(tile);
      return tile.state !== "failed";
    }
    const before = shown.length;
    let isWhole = true;
    for (const child of tile.children) isWhole = visit(child) && isWhole;
    if (isWhole || isEmpty) return isWhole;
    shown.length = before;
    shown.push(tile);
    return true;
  };
  visit(root);
  asked.sort(([a, x], [b, y]) => a.depth - b.depth || y - x);
  return { shown, used, wanted: asked.map(([tile]) => tile) };
}
