/** Opens a tileset: where its files come from, and what the page tells of it. */

import { find, isSmallScreen, makeText, tell } from "../elements";
import type { Payload } from "../payload";
import type { TerrainScene } from "../scene";
import { chooseFolder } from "./chooser";
import { MAJOR, RADIANS, SQUARED } from "./mapping";
import { formatError, TilesetModel } from "./model";
import { type Source, TilesetError, WebSource } from "./source";
import { chooseMapping, makeTiles, readHead } from "./tileset";

const FROM_FILE =
  "A browser lets no page that is opened from a file read other files: choose the folder of the tileset, drop it here, or put the page and the tileset on a web server.";
const EXAGGERATIONS = [1, 1.5, 2, 3, 5, 10, 15, 20, 30, 50, 100];
const RELIEF_SHARE = 0.1;
/** As of previews: the share of vertices that may be far off, and how far, in ranges of the others. */
const [MOST_SHARE, GAP] = [0.01, 4];
const MOST_FAILURES = 3;

/** Read a tileset and its first level; ask for its folder where there is no other way. */
export async function openTileset(payload: Payload): Promise<TilesetModel> {
  const { address } = payload.tileset!;
  const name = decodeURIComponent(address.split("/").pop() ?? "");
  const isServed = /^https?:$/.test(location.protocol);
  let source: Source = isServed ? new WebSource(address) : await chooseFolder(FROM_FILE, name);
  for (;;) {
    try {
      return await read(source, payload);
    } catch (error) {
      if (!(error instanceof TilesetError)) throw error;
      source = await chooseFolder(`The tileset cannot be shown: ${error.message}`, name);
    }
  }
}

async function read(source: Source, payload: Payload): Promise<TilesetModel> {
  const bytes = await source.read(source.root, new AbortController().signal);
  const head = readHead(new TextDecoder().decode(bytes), source.root);
  const mapping = chooseMapping(head, source.root);
  const root = makeTiles(head, source.root, mapping, null);
  const { isGlobe } = mapping;
  Object.assign(payload, {
    crs: isGlobe ? "WGS 84, longitude and latitude" : "coordinates of the tileset",
    units: { horizontal: "m", elevation: "m" },
    elevationName: isGlobe ? "Ellipsoidal height" : "Elevation",
    axes: [["X", 1], ["Y", 1]],
    geographic: isGlobe,
    ellipsoid: isGlobe ? [MAJOR, SQUARED, RADIANS] : null,
    origin: mapping.origin,
    scale: mapping.scale,
    decimals: [2, 2],
    elevationScale: 1,
  } satisfies Partial<Payload>);
  const model = new TilesetModel(root, source, mapping, payload, isSmallScreen());
  const heights = await model.begin();
  const relief = findRelief(heights).map((z) => z + mapping.origin[2]) as [number, number];
  payload.relief = relief;
  payload.elevations ??= relief;
  payload.exaggeration ||= chooseExaggeration(relief[1] - relief[0], root.high[0] - root.low[0], root.high[1] - root.low[1]);
  const notes = [payload.notes, ...head.notes, isGlobe ? "Heights are above the ellipsoid of WGS 84, as 3D Tiles have them." : ""];
  document.querySelector("#remarks p")!.textContent = notes.filter((one) => one !== "").join(" ");
  const made = head.crs === "" ? "" : `, made from ${head.crs}`;
  find<HTMLElement>("subtitle").textContent = `3D Tiles ${head.json.asset.version}${made} \u00b7 ${payload.crs}`;
  return model;
}

/** Return the lowest and the highest, but for few that are far off all others: as of previews. */
export function findRelief(heights: number[]): [number, number] {
  const ordered = Float64Array.from(heights).sort();
  const count = ordered.length;
  let [first, last] = [0, count - 1];
  const tail = Math.max(1, Math.floor(MOST_SHARE * count));
  const core = count >= 20 ? ordered[count - 1 - tail] - ordered[tail] : 0;
  if (core > 0) {
    for (let k = count - 1 - tail; k < count - 1; k += 1)
      if (ordered[k + 1] - ordered[k] > GAP * core) {
        last = k;
        break;
      }
    for (let k = tail; k > 0; k -= 1)
      if (ordered[k] - ordered[k - 1] > GAP * core) {
        first = k;
        break;
      }
  }
  return [ordered[first], ordered[last]];
}

function chooseExaggeration(relief: number, width: number, height: number): number {
  if (!(relief > 0)) return 1;
  const wanted = (RELIEF_SHARE * Math.max(width, height)) / relief;
  return EXAGGERATIONS.find((factor) => factor >= wanted) ?? EXAGGERATIONS[EXAGGERATIONS.length - 1];
}

/** Let a scene show the tileset, and tell what is shown and what could not be read. */
export function showTileset(model: TilesetModel, scene: TerrainScene): void {
  scene.add(model);
  model.follow(scene);
  const state = makeText("p", "");
  state.id = "tiles";
  find<HTMLElement>("subtitle").after(state);
  const failures = makeText("p", "");
  Object.assign(failures, { id: "failures", role: "alert" });
  state.after(failures);
  const showFailures = (): void => {
    const more = model.failures.length - MOST_FAILURES;
    failures.textContent = model.failures.slice(0, MOST_FAILURES).join(" ") + (more > 0 ? ` And ${more} more.` : "");
    if (more > -MOST_FAILURES) failures.textContent += " Coarser tiles are shown there, if there are any.";
  };
  model.failed = showFailures;
  showFailures();
  let isTold = false;
  scene.drawn.push(() => {
    const tiles = model.surface.parts.length;
    const coming = model.isFull
      ? `, not all of this view, which needs more than ${Math.round(model.mostBytes / 1e6)} MB: come nearer to see the others`
      : model.isSettled ? "" : ", finer ones are coming";
    const words = `${tiles === 1 ? "1 tile" : `${tiles} tiles`}, ${model.triangleCount.toLocaleString("en")} triangles, geometric error up to ${formatError(model.error)}${coming}`;
    if (state.textContent !== words) state.textContent = words;
    if (isTold || !model.isSettled) return;
    isTold = true;
    tell(`The tiles of this view are shown: ${words}.`);
  });
}
