/** Reading places, and measuring between them. */

import type { Marked } from "./annotations";
import { find, fix, makeText } from "./elements";
import { type Factors, makeGround } from "./ground";
import { crossesItself, measureArea, measureLine, profileAlong } from "./measuring";
import type { Payload } from "./payload";
import { drawProfile } from "./profile";
import type { TerrainScene } from "./scene";
import type { Theme } from "./theme";

export type Measured = "none" | "distance" | "area";

/** What is under the pointer, and what the marked places measure. */
export class Tool {
  readonly readout = find<HTMLElement>("readout");
  tool: Measured = "none";
  marked: Marked[] = [];
  private readonly ground: (y: number) => Factors;

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
    private readonly theme: Theme,
  ) {
    this.ground = makeGround(payload);
    for (const tool of ["distance", "area"] as const)
      find<HTMLElement>(tool).addEventListener("click", () => this.choose(tool));
    find<HTMLElement>("clear").addEventListener("click", () => this.clear());
  }

  /** Read or mark a place, whichever is chosen. */
  point(px: number, py: number): void {
    if (this.tool === "none") this.read(px, py);
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
      `Elevation ${fix(hit.z + origin[2], decimals[1])} ${units.elevation}`,
      `Slope ${model.surface.slope(hit.triangle).toFixed(1)}\u00b0`,
    ];
    // Isolated, for a name written from right to left would turn the numbers round.
    if (this.scene.models.length > 1) parts.push(`\u2068${model.surface.data.name.slice(0, 80)}\u2069`);
    return parts.map((part) => part.trim()).join("   ");
  }

  choose(tool: Measured): void {
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
    const found = this.scene.pick(px, py);
    if (found === null) return;
    this.marked.push(found);
    this.showMeasured();
  }

  showMeasured(): void {
    for (const tool of ["distance", "area"])
      find<HTMLElement>(tool).setAttribute("aria-pressed", String(this.tool === tool));
    this.scene.canvas.classList.toggle("measuring", this.tool !== "none");
    find<HTMLButtonElement>("clear").disabled = this.tool === "none";
    const box = find<HTMLElement>("measured");
    box.hidden = this.tool === "none";
    if (this.tool === "distance") this.showLine(box);
    else if (this.tool === "area") this.showArea(box);
    this.scene.request();
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
    const colors = this.payload.colors.themes[this.theme.name].curves;
    // What is coloured by cut and fill is one of the other surfaces once more.
    const models = this.scene.models.filter(({ surface }) => surface.difference === null);
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
}
