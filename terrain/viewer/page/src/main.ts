/** The page: unpacks the surfaces, shows them, and answers to mouse, touch and keys. */

import {
  chooseBar,
  drawLabels,
  drawLegend,
  drawMeasured,
  drawNorth,
  type Marked,
} from "./annotations";
import { type Tint, TINTS } from "./material";
import { type Factors, makeGround } from "./ground";
import { crossesItself, measureArea, measureLine, profileAlong } from "./measuring";
import { decodeOrtho } from "./ortho";
import { readPayload, type Payload } from "./payload";
import { chooseTicks, drawProfile } from "./profile";
import { Model, Stage } from "./scene";
import { drawStill } from "./still";
import { Surface } from "./surface";

const TITLES: Record<Tint, string> = {
  elevation: "Elevation",
  slope: "Slope",
  aspect: "Aspect",
  difference: "Cut and fill",
  plain: "Plain",
  ortho: "Ortho",
};
const CURVES = {
  light: ["#0b5fa5", "#c2185b", "#2e7d32", "#b84300", "#6a1b9a"],
  dark: ["#6cb2f0", "#f48fb1", "#81c784", "#ffab70", "#ce93d8"],
};
const START = { azimuth: 195, tilt: 35 };
const STEEPEST = 60;
const THEMES = { light: "#f4f2ee", dark: "#171b1f" };
const CLICK_PIXELS = 4;

type Tool = "none" | "distance" | "area";

function find<T extends Element>(id: string): T {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`the page has no element '${id}'`);
  return element as unknown as T;
}

class Page {
  readonly view = find<HTMLCanvasElement>("view");
  readonly notes = find<HTMLCanvasElement>("notes");
  readonly readout = find<HTMLElement>("readout");
  tool: Tool = "none";
  marked: Marked[] = [];
  tint: Tint = "elevation";
  dark = false;
  readonly ground: (y: number) => Factors;

  constructor(
    readonly payload: Payload,
    readonly stage: Stage,
    readonly isDraped: boolean,
  ) {
    this.ground = makeGround(payload);
    stage.drawn = () => this.annotate();
  }

  start(): void {
    this.fillPanel();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.view);
    this.resize();
    this.setExaggeration(this.payload.exaggeration);
    this.setTheme(matchMedia("(prefers-color-scheme: dark)").matches);
    this.setTint(this.isDraped ? "ortho" : this.payload.tint);
    if (this.payload.interval > 0) this.setContours();
    this.stage.look(START.azimuth, START.tilt);
    this.stage.draw();
  }

  // ---------------------------------------------------------------- settings

  private fillPanel(): void {
    const tints = find<HTMLSelectElement>("tint");
    const compared = this.stage.models.some((model) => model.surface.difference !== null);
    const absent: Partial<Record<Tint, boolean>> = { difference: !compared, ortho: !this.isDraped };
    for (const tint of TINTS) if (!absent[tint]) tints.add(new Option(TITLES[tint], tint));
    for (const place of document.querySelectorAll(".elevation-unit"))
      place.textContent = this.payload.units.elevation;
    find<HTMLInputElement>("contours").checked = this.payload.interval > 0;
    find<HTMLInputElement>("interval").value = String(this.payload.interval || this.chooseInterval());
    this.fillSurfaces();
    this.fillLayers();
  }

  private fillSurfaces(): void {
    const models = this.stage.models;
    const box = find<HTMLFieldSetElement>("surfaces");
    box.hidden = models.length < 2;
    models.forEach((model, k) => {
      model.group.visible = k === models.length - 1;
      box.append(
        makeSwitch(`surface-${k}`, model.surface.data.name, model.group.visible, (shown) => {
          model.group.visible = shown;
          this.stage.request();
        }),
      );
    });
  }

  private fillLayers(): void {
    const box = find<HTMLElement>("layers");
    const kinds = new Map<string, { title: string; color: string }>();
    for (const { surface } of this.stage.models)
      for (const layer of surface.data.lines) kinds.set(layer.kind, layer);
    for (const [kind, layer] of kinds) {
      const toggle = (shown: boolean): void => {
        for (const model of this.stage.models) {
          const object = model.layers.get(kind);
          if (object !== undefined) object.visible = shown;
        }
        this.stage.request();
      };
      box.append(makeSwitch(`layer-${kind}`, layer.title, true, toggle, layer.color));
    }
    if (this.stage.models.every((model) => model.labels === null)) return;
    box.append(
      makeSwitch("points", "Points and labels", false, (shown) => {
        for (const { labels } of this.stage.models) if (labels !== null) labels.marks.visible = shown;
        this.stage.request();
      }),
    );
  }

  private chooseInterval(): number {
    const [low, high] = this.stage.elevations;
    const ticks = chooseTicks(low, high, 24);
    return ticks.length > 1 ? Number((ticks[1] - ticks[0]).toPrecision(6)) : 1;
  }

  setTint(tint: Tint): void {
    this.tint = tint;
    find<HTMLSelectElement>("tint").value = tint;
    for (const model of this.stage.models) model.paint(tint, this.stage.ramps, this.range(tint));
    this.showLegend();
    this.stage.request();
  }

  private range(tint: Tint): [number, number] {
    if (tint === "slope") return [0, STEEPEST];
    if (tint === "aspect") return [0, 360];
    if (tint !== "difference") {
      const [low, high] = this.stage.elevations;
      return high > low ? [low, high] : [low - 0.5, high + 0.5];
    }
    let most = 0;
    for (const { surface } of this.stage.models)
      for (const value of surface.difference ?? []) most = Math.max(most, Math.abs(value));
    return [-most || -1, most || 1];
  }

  private showLegend(): void {
    const legend = find<HTMLElement>("legend");
    const shown = this.tint === "ortho" && !this.payload.ortho!.isWhole ? "elevation" : this.tint;
    legend.hidden = shown === "plain" || shown === "ortho";
    if (shown === "plain" || shown === "ortho") return;
    const unit = this.payload.units.elevation;
    const [low, high] = this.range(shown);
    const shift = this.payload.origin[2];
    const digits = Math.min(Math.max(0, 2 - Math.floor(Math.log10(high - low))), 20);
    const elevation = (z: number): string => fix(z + shift, digits);
    const ends: Record<Exclude<Tint, "plain" | "ortho">, [string, string[]]> = {
      elevation: [joinUnit("Elevation", unit), [low, (low + high) / 2, high].map(elevation)],
      slope: ["Slope, degrees", ["0", "15", "30", "45", "60+"]],
      aspect: ["Aspect, facing", ["N", "E", "S", "W", "N"]],
      difference: [joinUnit("Cut (below 0) and fill", unit), [low, 0, high].map((v) => fix(v, digits))],
    };
    const [title, ticks] = ends[shown];
    legend.querySelector("figcaption")!.textContent = title;
    find<HTMLElement>("ramp").style.background =
      `linear-gradient(to right, ${this.payload.ramps[shown].join(", ")})`;
    find<HTMLElement>("ramp").dataset.colors = this.payload.ramps[shown].join(" ");
    find<HTMLElement>("ticks").replaceChildren(...ticks.map((text) => makeText("span", text)));
  }

  setExaggeration(factor: number): void {
    const slider = find<HTMLInputElement>("exaggeration");
    slider.max = String(Math.max(2, Math.log10(factor)));
    slider.min = String(Math.min(-1, Math.log10(factor)));
    slider.value = String(Math.log10(factor));
    slider.setAttribute("aria-valuetext", `${Number(factor.toPrecision(3))} times`);
    find<HTMLOutputElement>("factor").value = `\u00d7 ${Number(factor.toPrecision(3))}`;
    this.stage.exaggerate(factor);
  }

  private setContours(): void {
    const shown = find<HTMLInputElement>("contours").checked;
    const interval = Number(find<HTMLInputElement>("interval").value);
    for (const model of this.stage.models)
      model.material.uniforms.interval.value = shown && interval > 0 ? interval : 0;
    this.stage.request();
  }

  setTheme(dark: boolean): void {
    this.dark = dark;
    const theme = dark ? "dark" : "light";
    document.documentElement.dataset.theme = theme;
    const button = find<HTMLButtonElement>("theme");
    button.setAttribute("aria-pressed", String(dark));
    this.stage.setBackground(THEMES[theme]);
    if (this.tool === "distance") this.showMeasured();
  }

  // ---------------------------------------------------------------- events

  private listen(): void {
    const on = (id: string, event: string, act: (target: HTMLInputElement) => void): void =>
      find<HTMLElement>(id).addEventListener(event, (e) => act(e.currentTarget as HTMLInputElement));
    on("tint", "change", (target) => this.setTint(target.value as Tint));
    on("exaggeration", "input", (target) => this.setExaggeration(10 ** Number(target.value)));
    on("contours", "change", () => this.setContours());
    on("interval", "input", () => this.setContours());
    on("edges", "change", (target) => {
      for (const model of this.stage.models) model.showEdges(target.checked);
      this.stage.request();
    });
    on("shading", "change", (target) => {
      for (const { material } of this.stage.models)
        material.uniforms.shading.value = target.checked ? 1 : 0;
      this.stage.request();
    });
    on("above", "click", () => this.stage.look(180, 90));
    on("start", "click", () => this.stage.look(START.azimuth, START.tilt));
    on("distance", "click", () => this.choose("distance"));
    on("area", "click", () => this.choose("area"));
    on("clear", "click", () => this.clear());
    on("picture", "click", () => this.savePicture());
    on("theme", "click", () => this.setTheme(!this.dark));
    on("fold", "click", (target) => {
      const settings = find<HTMLElement>("settings");
      settings.hidden = !settings.hidden;
      target.setAttribute("aria-expanded", String(!settings.hidden));
    });
    this.view.addEventListener("keydown", (event) => this.press(event));
    this.listenToPointer();
  }

  private listenToPointer(): void {
    let down: [number, number] | null = null;
    let waiting = false;
    const pressed = new Set<number>();
    this.view.addEventListener("pointerdown", (e) => {
      pressed.add(e.pointerId);
      // Two fingers move and zoom: none of them points at a place.
      down = pressed.size === 1 ? [e.offsetX, e.offsetY] : null;
    });
    this.view.addEventListener("pointercancel", (e) => {
      pressed.delete(e.pointerId);
      down = null;
    });
    this.view.addEventListener("pointerup", (e) => {
      pressed.delete(e.pointerId);
      if (down === null || e.button !== 0) return;
      if (Math.hypot(e.offsetX - down[0], e.offsetY - down[1]) >= CLICK_PIXELS) return;
      if (this.tool === "none") this.read(e.offsetX, e.offsetY);
      else this.mark(e.offsetX, e.offsetY);
    });
    this.view.addEventListener("pointermove", (e) => {
      if (waiting || e.buttons !== 0) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        this.read(e.offsetX, e.offsetY);
      });
    });
  }

  private press(event: KeyboardEvent): void {
    const moves: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
    };
    const move = moves[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (move !== undefined && event.shiftKey) this.stage.move(0.05 * move[0], 0.05 * move[1]);
    else if (move !== undefined) this.stage.turn(0.06 * move[0], 0.05 * move[1]);
    else if (event.key === "+" || event.key === "=") this.stage.zoom(1.15);
    else if (event.key === "-") this.stage.zoom(1 / 1.15);
    else if (event.key.toLowerCase() === "t") this.stage.look(180, 90);
    else if (event.key.toLowerCase() === "h") this.stage.look(START.azimuth, START.tilt);
    else if (event.key === "Escape") this.clear();
    else if (event.key === "Enter") this.readMiddle();
    else return;
    event.preventDefault();
  }

  private readMiddle(): void {
    const [x, y] = [this.view.clientWidth / 2, this.view.clientHeight / 2];
    if (this.tool === "none") this.read(x, y);
    else this.mark(x, y);
  }

  // ---------------------------------------------------------------- places

  /** Say what lies under a pixel of the page. */
  read(px: number, py: number): void {
    const found = this.stage.pick(px, py);
    this.readout.textContent = found === null ? "" : this.describe(found);
  }

  private describe({ model, hit }: Marked): string {
    const { origin, units, scale, geographic, axes } = this.payload;
    const decimals = geographic ? [7, this.payload.decimals[1]] : this.payload.decimals;
    const names = geographic ? ["Longitude", "Latitude"] : [axes[0][0], axes[1][0]];
    const unit = geographic ? "\u00b0" : ` ${units.horizontal}`;
    const [x, y] = [axes[0][1] * (hit.x / scale[0] + origin[0]), axes[1][1] * (hit.y / scale[1] + origin[1])];
    const parts = [
      `${names[0]} ${fix(x, decimals[0])}${unit}`,
      `${names[1]} ${fix(y, decimals[0])}${unit}`,
      `Elevation ${fix(hit.z + origin[2], decimals[1])} ${units.elevation}`,
      `Slope ${model.surface.slope(hit.triangle).toFixed(1)}\u00b0`,
    ];
    // Isolated, for a name written from right to left would turn the numbers round.
    if (this.stage.models.length > 1) parts.push(`\u2068${model.surface.data.name.slice(0, 80)}\u2069`);
    return parts.map((part) => part.trim()).join("   ");
  }

  choose(tool: Tool): void {
    this.tool = this.tool === tool ? "none" : tool;
    this.marked = [];
    this.showMeasured();
  }

  clear(): void {
    this.tool = "none";
    this.marked = [];
    this.showMeasured();
  }

  mark(px: number, py: number): void {
    const found = this.stage.pick(px, py);
    if (found === null) return;
    this.marked.push(found);
    this.showMeasured();
  }

  private showMeasured(): void {
    for (const tool of ["distance", "area"])
      find<HTMLElement>(tool).setAttribute("aria-pressed", String(this.tool === tool));
    this.view.classList.toggle("measuring", this.tool !== "none");
    find<HTMLButtonElement>("clear").disabled = this.tool === "none";
    const box = find<HTMLElement>("measured");
    box.hidden = this.tool === "none";
    if (this.tool === "distance") this.showLine(box);
    else if (this.tool === "area") this.showArea(box);
    this.stage.request();
  }

  private showLine(box: HTMLElement): void {
    if (this.marked.length < 2) {
      box.replaceChildren(makeText("span", "Click two places or more on the terrain."));
      return;
    }
    const { units, elevationScale, decimals } = this.payload;
    const { length, covered, groundLength, rise } = measureLine(
      this.marked,
      elevationScale,
      this.ground,
    );
    const say = (value: number): string => `${value.toFixed(decimals[0])} ${units.horizontal}`.trim();
    const isWhole = covered > length * (1 - 1e-6);
    const text =
      `Distance ${say(length)}, along the ground ${say(groundLength)}` +
      `${isWhole ? "" : ` on the ${say(covered)} that are on the surface`}, ` +
      `rise ${fix(rise, decimals[1])} ${units.elevation}`.trimEnd();
    const shift = this.payload.origin[2];
    const colors = CURVES[this.dark ? "dark" : "light"];
    // What is coloured by cut and fill is one of the other surfaces once more.
    const models = this.stage.models.filter(({ surface }) => surface.difference === null);
    const curves = models.map(({ surface }, k) => ({
      name: surface.data.name,
      color: colors[k % colors.length],
      pieces: profileAlong(this.marked, surface, this.ground).map((piece) =>
        piece.map(([d, z]): [number, number] => [d, z + shift]),
      ),
    }));
    const names = curves.length < 2 ? [] : curves.map(({ name, color }) => makeText("span", `\u2014 ${name} `, color));
    box.replaceChildren(makeText("div", text), ...names, drawProfile(curves, units));
  }

  private showArea(box: HTMLElement): void {
    if (this.marked.length < 3) {
      box.replaceChildren(makeText("span", "Click three places or more around the area."));
      return;
    }
    const { units, decimals } = this.payload;
    const { area, perimeter } = measureArea(this.marked, this.ground);
    const unit = units.horizontal;
    const square = unit === "" ? "" : ` ${unit}\u00b2`;
    const around = `perimeter ${perimeter.toFixed(decimals[0])} ${unit}`.trim();
    const text = crossesItself(this.marked)
      ? "The sides of the polygon cross: its area cannot be told."
      : `Area ${area.toFixed(decimals[0])}${square}, ${around}`;
    box.replaceChildren(makeText("span", text));
  }

  // ---------------------------------------------------------------- what is drawn over the picture

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.view;
    if (width === 0 || height === 0) return;
    this.stage.resize(width, height);
    const ratio = Math.min(window.devicePixelRatio, 2);
    this.notes.width = width * ratio;
    this.notes.height = height * ratio;
  }

  private annotate(): void {
    const pen = this.notes.getContext("2d");
    if (pen === null) return;
    const ratio = this.notes.width / this.view.clientWidth;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.view.clientWidth, this.view.clientHeight);
    const [ink, halo] = this.dark ? ["#eceff1", "#171b1f"] : ["#20262b", "#ffffff"];
    drawLabels(pen, this.stage, ink, halo);
    drawMeasured(pen, this.stage, this.marked, this.tool === "area");
    find<SVGElement>("north").querySelector("g")!.setAttribute("transform", `rotate(${-this.stage.heading})`);
    const [length, pixels] = chooseBar(this.stage.unitsPerPixel, 140);
    const bar = find<HTMLElement>("bar");
    bar.querySelector("span")!.textContent = `${Number(length.toPrecision(6))} ${this.payload.units.horizontal}`.trim();
    bar.querySelector("i")!.style.width = `${pixels}px`;
  }

  private savePicture(): void {
    const link = document.createElement("a");
    link.download = `${this.payload.title.replace(/[^\p{L}\p{N} _-]+/gu, "").slice(0, 80) || "terrain"}.png`;
    link.href = this.takePicture();
    link.click();
  }

  /** Return the present view with its annotations as a PNG in a data URL. */
  takePicture(): string {
    this.stage.draw();
    const sheet = document.createElement("canvas");
    [sheet.width, sheet.height] = [this.view.width, this.view.height];
    const pen = sheet.getContext("2d")!;
    pen.drawImage(this.view, 0, 0);
    pen.drawImage(this.notes, 0, 0, sheet.width, sheet.height);
    const ratio = sheet.width / this.view.clientWidth;
    pen.scale(ratio, ratio);
    pen.fillStyle = this.dark ? "#eceff1" : "#20262b";
    pen.font = "600 20px system-ui, sans-serif";
    pen.fillText(this.payload.title, 16, 32, this.view.clientWidth - 32);
    pen.font = "14px system-ui, sans-serif";
    const bar = find<HTMLElement>("bar");
    const width = bar.querySelector("i")!.getBoundingClientRect().width;
    pen.fillRect(16, this.view.clientHeight - 24, width, 3);
    pen.fillText(`${bar.querySelector("span")!.textContent ?? ""}, ${this.payload.crs}`, 16, this.view.clientHeight - 32);
    const legend = find<HTMLElement>("legend");
    if (!legend.hidden) drawLegend(pen, legend, this.view);
    drawNorth(pen, this.view.clientWidth - 40, 40, this.stage.heading);
    return sheet.toDataURL("image/png");
  }
}

/** Write a number with so many decimals, and nought without a minus. */
function fix(value: number, decimals: number): string {
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text;
}

function joinUnit(words: string, unit: string): string {
  return unit === "" ? words : `${words}, ${unit}`;
}

function makeText(tag: string, text: string, color = ""): HTMLElement {
  const element = document.createElement(tag);
  element.textContent = text;
  if (color !== "") element.style.color = color;
  return element;
}

function makeSwitch(
  id: string,
  title: string,
  checked: boolean,
  act: (shown: boolean) => void,
  color = "",
): HTMLElement {
  const label = document.createElement("label");
  const box = document.createElement("input");
  Object.assign(box, { type: "checkbox", id, checked });
  box.addEventListener("change", () => act(box.checked));
  label.append(box, " ");
  if (color !== "") {
    const sample = document.createElement("i");
    sample.style.borderColor = color;
    label.append(sample);
  }
  const words = document.createElement("span");
  Object.assign(words, { textContent: title, dir: "auto", title });
  label.append(words);
  return label;
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
  let stage: Stage;
  try {
    stage = new Stage(find<HTMLCanvasElement>("view"), payload);
  } catch {
    showStill(payload, surfaces[surfaces.length - 1], picture, words);
    return null;
  }
  for (const surface of surfaces) {
    const model = new Model(surface, payload);
    await model.addLayers();
    stage.add(model);
  }
  if (picture !== null) stage.drape(picture);
  const page = new Page(payload, stage, picture !== null);
  page.start();
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
