/** The page: unpacks the surfaces, shows them, and answers to mouse, touch and keys. */

import { find } from "./elements";
import { Furniture } from "./furniture";
import { makeGround } from "./ground";
import { Legend } from "./legend";
import { decodeOrtho } from "./ortho";
import { readPayload, type Payload } from "./payload";
import { Model, TerrainScene } from "./scene";
import { Settings } from "./settings";
import { drawStill } from "./still";
import { Surface } from "./surface";
import { Theme } from "./theme";
import { Tool } from "./tool";

const START = { azimuth: 195, tilt: 35 };
const CLICK_PIXELS = 4;

/** The parts of the page, each with its own elements, and the pointer and keys over the view. */
class Page {
  readonly theme: Theme;
  readonly legend: Legend;
  readonly settings: Settings;
  readonly tool: Tool;
  readonly furniture: Furniture;

  constructor(
    readonly payload: Payload,
    readonly scene: TerrainScene,
    isDraped: boolean,
  ) {
    this.theme = new Theme(payload, scene);
    this.legend = new Legend(payload, scene, isDraped);
    this.tool = new Tool(payload, scene, this.theme);
    this.furniture = new Furniture(payload, scene, this.theme, this.legend, this.tool);
    this.settings = new Settings(payload, scene);
    this.legend.setTint(isDraped ? "ortho" : payload.tint);
    this.theme.changed = () => this.tool.showMeasured();
    this.listen();
    this.lookFromStart();
    scene.draw();
  }

  private lookFromStart(): void {
    this.scene.look(START.azimuth, START.tilt);
  }

  private listen(): void {
    const view = this.scene.canvas;
    let down: [number, number] | null = null;
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
      this.tool.point(e.offsetX, e.offsetY);
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
    else if (event.key === "Escape") this.tool.clear();
    else if (event.key === "Enter") this.tool.point(this.scene.canvas.clientWidth / 2, this.scene.canvas.clientHeight / 2);
    else return;
    event.preventDefault();
  }
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
  for (const id of ["panel", "north", "bar", "legend"])
    document.getElementById(id)?.setAttribute("style", "display: none");
}

async function open(): Promise<Page | null> {
  const words = find<HTMLElement>("wait");
  const payload = readPayload("terrain");
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
  for (const surface of surfaces) {
    const model = new Model(surface, payload);
    await model.addLayers();
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
