/** Reading places, and measuring between them. */

import type { Marked } from "../annotations";
import { find, fix, isSmallScreen, makeText, offerFile, tell } from "../elements";
import { type Factors, makeGround } from "../ground";
import type { Payload } from "../payload";
import type { TerrainScene } from "../scene";
import type { Theme } from "../theme";
import { crossesItself, measureArea, measureLine, measureSegment } from "./measuring";
import type { OnLine, Place } from "./network";
import { drawProfile } from "./profile";
import { cutSection, type Segment, traceCurve, writeCsv } from "./section";

export const TOOLS = ["distance", "area", "along"] as const;
export type Measured = "none" | (typeof TOOLS)[number];

/** Pixels within which a line is reached, and two clicks are one. */
const REACH = 24;
const SAME_CLICK = 3;
/** Share of the distance to the eye by which a line may lie behind the surface in front of it. */
const BEHIND = 0.01;
const HINTS: Record<Exclude<Measured, "none">, string> = {
  distance: "Click two places or more on the terrain.",
  area: "Click three places or more around the area.",
  along: "Click two places or more on breaklines or other lines.",
};
const BY_KEYS = "By keys: Space marks the place in the middle, Enter ends, Escape cancels.";

/** What is under the pointer, and what the marked places measure. */
export class Tool {
  readonly readout = find<HTMLElement>("readout");
  tool: Measured = "none";
  marked: Marked[] = [];
  /** Whether no more places are marked. */
  isEnded = false;
  private ways: Place[][] = [];
  private lastOnLine: OnLine[] = [];
  private readonly ground: (y: number) => Factors;

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
    private readonly theme: Theme,
  ) {
    this.ground = makeGround(payload);
    find<HTMLElement>("along").hidden = scene.models.every(({ network }) => network.isEmpty);
    for (const tool of TOOLS)
      find<HTMLElement>(tool).addEventListener("click", () => {
        this.choose(tool);
        scene.canvas.focus({ preventScroll: true });
      });
    const acts = { done: () => this.end(), undo: () => this.undo(), export: () => this.saveCsv(), clear: () => this.clear() };
    for (const [id, act] of Object.entries(acts)) find<HTMLElement>(id).addEventListener("click", act);
    window.addEventListener("resize", () => this.showMeasured());
  }

  get isMeasuring(): boolean {
    return this.tool !== "none" && !this.isEnded;
  }

  /** The line that is measured: the marked places, or the way along lines between them. */
  get path(): Marked[] {
    if (this.tool !== "along" || this.marked.length === 0) return this.marked;
    const { model } = this.marked[0];
    const places = this.ways.flatMap((way, k) => (k === 0 ? way : way.slice(1)));
    if (places.length === 0) return this.marked;
    return places.map(([x, y, z]) => ({ model, hit: { triangle: -1, x, y, z } }));
  }

  /** Read or mark a place, whichever is chosen. */
  point(px: number, py: number): void {
    if (!this.isMeasuring) this.read(px, py);
    else if (this.tool === "along") this.markOnLine(px, py);
    else this.mark(px, py);
  }

  /** Write what lies under a pixel of the page. */
  read(px: number, py: number): void {
    const found = this.scene.pick(px, py);
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
      `${this.payload.elevationName} ${fix(hit.z + origin[2], decimals[1])} ${units.elevation}`,
      `Slope ${model.surface.slope(hit.triangle).toFixed(1)}\u00b0`,
    ];
    if (model.surface.difference !== null) {
      const change = model.surface.differenceAt(hit);
      parts.push(`${change < 0 ? "Cut" : "Fill"} ${fix(Math.abs(change), decimals[1])} ${units.elevation}`);
    }
    parts.push(model.describeExactness([hit]));
    // Isolated, for a name written from right to left would turn the numbers round.
    if (this.scene.models.length > 1) parts.push(`\u2068${model.surface.data.name.slice(0, 80)}\u2069`);
    return parts.map((part) => part.trim()).filter((part) => part !== "").join("   ");
  }

  choose(tool: Measured): void {
    this.restart(this.tool === tool ? "none" : tool);
    if (this.tool !== "none") tell(`${HINTS[this.tool]} ${BY_KEYS}`);
  }

  /** Cancel what is measured. */
  clear(): void {
    if (this.tool === "none") return;
    if (find<HTMLElement>("measured").contains(document.activeElement)) this.scene.canvas.focus();
    this.restart("none");
    tell("The measurement is cancelled.");
  }

  private restart(tool: Measured): void {
    this.tool = tool;
    this.isEnded = false;
    this.marked = [];
    this.ways = [];
    this.lastOnLine = [];
    this.showMeasured();
  }

  /** Keep what is measured, and mark no more places. */
  end(): void {
    if (!this.isMeasuring) return;
    if (document.activeElement === find<HTMLElement>("done")) this.scene.canvas.focus();
    this.isEnded = true;
    this.showMeasured();
    tell(`Measurement ended. ${find<HTMLElement>("result").textContent ?? ""}`);
  }

  /** Take the last place back. */
  undo(): void {
    if (this.tool === "none" || this.marked.length === 0) return;
    this.isEnded = false;
    this.marked.pop();
    this.lastOnLine.pop();
    this.ways.pop();
    this.showMeasured();
    this.tellResult();
  }

  mark(px: number, py: number): void {
    const found = this.scene.pick(px, py);
    if (found === null) {
      tell("There is no surface at this place.");
      return;
    }
    if (this.isSameClick(found)) return;
    this.marked.push(found);
    this.showMeasured();
    this.tellResult();
  }

  /** The second click of two at one place marks nothing more. */
  private isSameClick({ hit }: Marked): boolean {
    const last = this.marked[this.marked.length - 1]?.hit;
    if (last === undefined) return false;
    const pixel = this.scene.unitsPerPixel;
    return Math.hypot(hit.x - last.x, hit.y - last.y) < Math.min(SAME_CLICK * pixel, 1e-3 * this.scene.span);
  }

  /** Mark the place on a line next to a pixel, and find the way to it along lines. */
  private markOnLine(px: number, py: number): void {
    const found = this.reachLine(px, py);
    if (found === null) {
      this.warn("There is no line here.");
      return;
    }
    const { model, onLine } = found;
    const hit = { triangle: -1, x: onLine.place[0], y: onLine.place[1], z: onLine.place[2] };
    const before = this.lastOnLine[this.lastOnLine.length - 1];
    if (before !== undefined) {
      if (this.isSameClick({ model, hit })) return;
      const measure = (a: Place, b: Place): number =>
        measureSegment({ x: a[0], y: a[1] }, { x: b[0], y: b[1] }, this.ground);
      const way = model === this.marked[0].model ? model.network.findWay(before, onLine, measure) : null;
      if (way === null) {
        this.warn("This line is not connected to the one before.");
        return;
      }
      this.ways.push(way);
    }
    this.lastOnLine.push(onLine);
    this.marked.push({ model, hit });
    this.showMeasured();
    this.tellResult();
  }

  private warn(words: string): void {
    tell(words);
    this.showMeasured(words);
  }

  private reachLine(px: number, py: number): { model: Marked["model"]; onLine: OnLine } | null {
    const { scene } = this;
    for (const model of scene.listShown(px)) {
      const kinds = new Set([...model.layers].filter(([, one]) => one.visible).map(([kind]) => kind));
      for (const onLine of model.network.reach(px, py, kinds, REACH, (place) => scene.project(...place, true)))
        if (!this.isHidden(onLine.place)) return { model, onLine };
    }
    return null;
  }

  /** Whether a surface stands before a place. */
  private isHidden([x, y, z]: Place): boolean {
    const at = this.scene.project(x, y, z, true);
    if (at === null) return true;
    const front = this.scene.pick(at[0], at[1]);
    if (front === null) return false;
    const { hit } = front;
    const before = this.scene.project(hit.x, hit.y, hit.z, true);
    return before !== null && before[2] < at[2] * (1 - BEHIND);
  }

  /** Measure anew on what is shown now. */
  renew(): void {
    for (const one of this.marked) {
      const { hit, model } = one;
      const { surface } = model;
      one.hit = surface.pick([hit.x, hit.y, surface.high[2] + 1], [0, 0, -1], 1) ?? hit;
    }
    if (this.marked.length > 0) this.showMeasured();
  }

  private tellResult(): void {
    const count = this.marked.length;
    tell(`${count === 1 ? "1 place" : `${count} places`}. ${find<HTMLElement>("result").textContent ?? ""}`);
  }

  showMeasured(warning = ""): void {
    for (const tool of TOOLS)
      find<HTMLElement>(tool).setAttribute("aria-pressed", String(this.tool === tool));
    this.scene.canvas.classList.toggle("measuring", this.isMeasuring);
    find<HTMLElement>("measured").hidden = this.tool === "none";
    find<HTMLElement>("done").hidden = this.isEnded;
    find<HTMLButtonElement>("undo").disabled = this.marked.length === 0;
    find<HTMLElement>("export").hidden = this.tool === "area";
    find<HTMLButtonElement>("export").disabled = this.path.length < 2;
    find<HTMLElement>("curves").replaceChildren();
    if (this.tool === "area") this.say(this.describeArea());
    else if (this.tool !== "none") this.showLine(this.tool);
    if (warning !== "") this.say(`${warning} ${find<HTMLElement>("result").textContent ?? ""}`);
    this.scene.request();
  }

  private say(words: string): void {
    find<HTMLElement>("result").textContent = words;
  }

  private showLine(tool: "distance" | "along"): void {
    const { path } = this;
    this.say(path.length < 2 ? HINTS[tool] : this.describeLine(path));
    const { units } = this.payload;
    const box = find<HTMLElement>("curves");
    const width = Math.min(Math.max(find<HTMLElement>("measured").clientWidth - 24, 280), 900);
    const shift = this.payload.origin[2];
    const colors = this.payload.colors.themes[this.theme.name].curves;
    const surfaces = this.listSurfaces();
    const segments = path.length < 2 ? [] : this.cut();
    const curves = surfaces.map(({ data }, k) => ({
      name: data.name,
      color: colors[k % colors.length],
      pieces: traceCurve(segments, k).map((piece) => piece.map(([d, z]): [number, number] => [d, z + shift])),
    }));
    const names = curves.length < 2 || segments.length === 0 ? [] : curves.map(({ name, color }) => makeText("span", `\u2014 ${name}`, color));
    // Drawn before there is a line, too: so the view does not change its size with the second place.
    const height = !isSmallScreen() ? 150 : window.innerHeight < 500 ? 80 : 96;
    box.replaceChildren(...names, drawProfile(curves, units, [width, height], this.payload.elevationName.toLowerCase()));
  }

  /** What is coloured by cut and fill is one of the other surfaces once more. */
  private listSurfaces(): Marked["model"]["surface"][] {
    return this.scene.models.map(({ surface }) => surface).filter(({ difference }) => difference === null);
  }

  private cut(): Segment[] {
    const owner = this.tool === "along" ? this.marked[0].model.surface : undefined;
    return cutSection(this.path, this.listSurfaces(), this.ground, owner);
  }

  private describeLine(path: Marked[]): string {
    const { units, elevationScale, decimals } = this.payload;
    const isAlong = this.tool === "along";
    const { length, covered, groundLength, rise } = measureLine(path, elevationScale, this.ground, isAlong);
    const say = (value: number): string => `${value.toFixed(decimals[0])} ${units.horizontal}`.trim();
    const isWhole = covered > length * (1 - 1e-6);
    const grade = length > 0 ? `, grade ${fix((100 * rise * elevationScale) / length, 2)} %` : "";
    return (
      `Distance ${say(length)}${isAlong ? " along the line" : ""}, along the ground ${say(groundLength)}` +
      `${isWhole ? "" : ` on the ${say(covered)} that are on the surface`}, ` +
      `rise ${fix(rise, decimals[1])} ${units.elevation}`.trimEnd() + grade + this.describeExactness(path)
    );
  }

  private describeExactness(path: Marked[]): string {
    const words = path[0].model.describeExactness(path.map(({ hit }) => hit));
    return words === "" ? "" : `. ${words}`;
  }

  private describeArea(): string {
    if (this.marked.length < 3) return HINTS.area;
    if (crossesItself(this.marked)) return "The sides of the polygon cross: its area cannot be told.";
    const { units, decimals } = this.payload;
    const { area, perimeter } = measureArea(this.marked, this.ground);
    const unit = units.horizontal;
    const square = unit === "" ? "" : ` ${unit}\u00b2`;
    return `Area ${area.toFixed(decimals[0])}${square}, perimeter ${perimeter.toFixed(decimals[0])} ${unit}`.trim();
  }

  /** Return the section along the measured line as CSV. */
  formatCsv(): string {
    return writeCsv(this.cut(), this.listSurfaces().map(({ data }) => data.name), this.payload);
  }

  private saveCsv(): void {
    if (this.path.length < 2) return;
    const address = URL.createObjectURL(new Blob([this.formatCsv()], { type: "text/csv" }));
    offerFile(this.payload.title, " section.csv", address);
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }
}
