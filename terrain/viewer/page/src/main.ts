/** The page: unpacks the surfaces, shows them, and answers to mouse, touch and keys. */

import { Comparison } from "./comparison";
import { find, tell } from "./elements";
import { Furniture } from "./furniture";
import { makeGround } from "./ground";
import { Legend } from "./legend";
import { Link } from "./link";
import { decodeOrtho } from "./ortho";
import { readPayload, type Payload } from "./payload";
import { SurfaceModel, TerrainScene } from "./scene";
import { Settings } from "./settings";
import { drawStill } from "./still";
import { Surface } from "./surface";
import { Theme } from "./theme";
import type { TilesetModel } from "./tiles/model";
import { openTileset, showTileset } from "./tiles/opening";
import { Tool } from "./measure/tool";

const START = { azimuth: 195, tilt: 35 };
const CLICK_PIXELS = 4;
/** Milliseconds within which two clicks are a double one. */
const DOUBLE_CLICK = 400;
const COMPASS = ["north", "northeast", "east", "southeast", "south", "southwest", "west", "northwest"];
/** Milliseconds of rest after which the direction of the view is told. */
const TELL_AFTER = 700;

/** The parts of the page, each with its own elements, and the pointer and keys over the view. */
class Page {
  readonly theme: Theme;
  readonly legend: Legend;
  readonly settings: Settings;
  readonly tool: Tool;
  readonly furniture: Furniture;
  readonly comparison: Comparison;
  readonly link: Link;

  tileset: TilesetModel | null = null;
  private telling = 0;

  constructor(
    readonly payload: Payload,
    readonly scene: TerrainScene,
    isDraped: boolean,
  ) {
    this.theme = new Theme(payload, scene);
    this.legend = new Legend(payload, scene, isDraped);
    this.tool = new Tool(payload, scene, this.theme);
    this.furniture = new Furniture(payload, scene, this.theme, this.legend, this.tool);
    this.settings = new Settings(payload, scene, this.legend);
    this.comparison = new Comparison(scene, this.settings);
    this.legend.setTint(isDraped ? "ortho" : payload.tint);
    this.theme.changed = () => this.tool.showMeasured();
    this.listen();
    describeExtent(payload, scene);
    this.lookFromStart();
    this.link = new Link(payload, scene, this);
    scene.draw();
  }

  private lookFromStart(): void {
    this.scene.look(START.azimuth, START.tilt);
  }

  private listen(): void {
    const view = this.scene.canvas;
    let down: [number, number] | null = null;
    let last = [0, 0, -Infinity];
    let waiting = false;
    const pressed = new Set<number>();
    view.addEventListener("pointerdown", (e) => {
      pressed.add(e.pointerId);
      // Two fingers move and zoom: none of them points at a place.
      down = pressed.size === 1 ? [e.offsetX, e.offsetY] : null;
    });
    view.addEventListener("pointercancel", (e) => {
      pressed.delete(e.pointerId);
      down = null;
    });
    view.addEventListener("pointerup", (e) => {
      pressed.delete(e.pointerId);
      if (down === null || e.button !== 0) return;
      if (Math.hypot(e.offsetX - down[0], e.offsetY - down[1]) >= CLICK_PIXELS) return;
      // Told here, as the view may have another size after the first of two clicks.
      const isSecond = e.timeStamp - last[2] < DOUBLE_CLICK
        && Math.hypot(e.offsetX - last[0], e.offsetY - last[1]) < 3 * CLICK_PIXELS;
      last = [e.offsetX, e.offsetY, e.timeStamp];
      if (isSecond && this.tool.isMeasuring) this.tool.end();
      else this.tool.point(e.offsetX, e.offsetY);
    });
    view.addEventListener("pointermove", (e) => {
      if (waiting || e.buttons !== 0) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        this.tool.read(e.offsetX, e.offsetY);
      });
    });
    view.addEventListener("keydown", (event) => this.press(event));
    for (const change of ["focus", "blur"]) view.addEventListener(change, () => this.scene.request());
    document.addEventListener("keydown", (event) => this.pressAnywhere(event));
    find<HTMLElement>("above").addEventListener("click", () => this.scene.look(180, 90));
    find<HTMLElement>("start").addEventListener("click", () => this.lookFromStart());
  }

  private press(event: KeyboardEvent): void {
    const moves: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
    };
    const move = moves[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (move !== undefined && event.shiftKey) this.scene.move(0.05 * move[0], 0.05 * move[1]);
    else if (move !== undefined) this.scene.turn(0.06 * move[0], 0.05 * move[1]);
    else if (event.key === "+" || event.key === "=") this.scene.zoom(1.15);
    else if (event.key === "-") this.scene.zoom(1 / 1.15);
    else if (event.key.toLowerCase() === "t") this.scene.look(180, 90);
    else if (event.key.toLowerCase() === "h") this.lookFromStart();
    else if (event.key === "Backspace") this.tool.undo();
    else if (event.key === "Enter" && this.tool.isMeasuring) this.tool.end();
    else if (event.key === "Enter" || event.key === " ") this.pointAtMiddle();
    else return;
    event.preventDefault();
    if (move !== undefined) this.tellView();
  }

  /** Keys that end or cancel a measurement, unless a control has them for itself. */
  private pressAnywhere(event: KeyboardEvent): void {
    if (event.defaultPrevented) return;
    if (event.key === "Escape") this.tool.clear();
    else if (event.key === "Enter" && event.target === document.body) this.tool.end();
  }

  private pointAtMiddle(): void {
    const { clientWidth, clientHeight } = this.scene.canvas;
    this.tool.point(clientWidth / 2, clientHeight / 2);
  }

  /** Say where the view looks, once it rests. */
  private tellView(): void {
    clearTimeout(this.telling);
    this.telling = window.setTimeout(() => {
      const { azimuth, tilt } = this.scene.standpoint;
      const side = COMPASS[Math.round(azimuth / 45) % COMPASS.length];
      tell(`Seen from the ${side}, ${Math.round(tilt)} degrees above the horizon.`);
    }, TELL_AFTER);
  }
}

/** Describe the surfaces to those who do not see them. */
function describeExtent({ units, origin, elevationName, decimals }: Payload, scene: TerrainScene): void {
  const [low, high] = scene.elevations.map((z) => Number((z + origin[2]).toFixed(Math.max(2, decimals[1]))));
  const [width, height] = scene.extent.map((one) => Number(one.toPrecision(4)));
  find<HTMLElement>("extent").textContent =
    `${elevationName}s from ${low} to ${`${high} ${units.elevation}`.trim()}; ` +
    `${`${width} ${units.horizontal}`.trim()} from west to east, ${`${height} ${units.horizontal}`.trim()} from south to north.`;
}

/** Show the terrain as a flat picture, and say why. */
function showStill(
  payload: Payload,
  surface: Surface,
  picture: ImageBitmap | null,
  words: HTMLElement,
): void {
  words.textContent = "This browser has no WebGL, so the terrain is shown as a still picture.";
  words.style.inset = "auto 10% 24px";
  const canvas = find<HTMLCanvasElement>("notes");
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
  drawStill(canvas, surface, payload, picture);
  for (const id of ["side", "north", "bar", "readout"])
    document.getElementById(id)?.setAttribute("style", "display: none");
}

/** Show a tileset, streamed by level. */
async function openTiles(payload: Payload): Promise<Page | null> {
  const words = find<HTMLElement>("wait");
  let scene: TerrainScene;
  try {
    scene = new TerrainScene(find<HTMLCanvasElement>("view"), payload);
  } catch {
    words.textContent = "This browser has no WebGL, without which a tileset cannot be shown.";
    for (const id of ["side", "north", "bar", "readout"]) find<HTMLElement>(id).style.display = "none";
    return null;
  }
  const model = await openTileset(payload);
  showTileset(model, scene);
  const page = new Page(payload, scene, false);
  page.tileset = model;
  model.changed = () => page.tool.renew();
  words.remove();
  return page;
}

async function open(): Promise<Page | null> {
  const words = find<HTMLElement>("wait");
  const payload = readPayload("terrain");
  if (payload.tileset !== null) return openTiles(payload);
  const surfaces: Surface[] = [];
  const ground = makeGround(payload);
  for (const data of payload.surfaces)
    surfaces.push(await Surface.unpack(data, payload.elevationScale, ground));
  const picture = payload.ortho === null ? null : await decodeOrtho(payload.ortho);
  let scene: TerrainScene;
  try {
    scene = new TerrainScene(find<HTMLCanvasElement>("view"), payload);
  } catch {
    showStill(payload, surfaces[surfaces.length - 1], picture, words);
    return null;
  }
  for (const [k, data] of payload.surfaces.entries()) {
    const surface = surfaces[k];
    const model = new SurfaceModel(surface, payload, data.step);
    await model.addLayers(data);
    scene.add(model);
  }
  if (picture !== null) scene.drape(picture);
  const page = new Page(payload, scene, picture !== null);
  words.remove();
  return page;
}

declare global {
  interface Window {
    /** The page once it is open, for tests and for scripts of those who embed it. */
    terrain: Promise<Page | null>;
  }
}

window.terrain = open();
window.terrain.catch((error: unknown) => {
  find<HTMLElement>("wait").textContent = `The terrain cannot be shown: ${String(error)}`;
  throw error;
});
