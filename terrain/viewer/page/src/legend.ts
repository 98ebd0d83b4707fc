/** Colours of the surfaces: what they show, and the legend that says so. */

import { find, fix, joinUnit, makeText } from "./elements";
import { type Tint, TINTS } from "./material";
import type { Payload } from "./payload";
import type { TerrainScene } from "./scene";

/** Letters of the ticks together that fit below the ramp. */
const MOST_LETTERS = 30;

const TITLES: Record<Tint, string> = {
  elevation: "Elevation",
  slope: "Slope",
  aspect: "Aspect",
  difference: "Cut and fill",
  plain: "Plain",
  ortho: "Ortho",
  given: "Colours of the file",
};
const STEEPEST = 60;

/** The choice of colours and the legend. */
export class Legend {
  readonly box = find<HTMLElement>("legend");
  private readonly choice = find<HTMLSelectElement>("tint");
  tint: Tint = "elevation";
  /** Called when other colours are chosen. */
  chosen: (tint: Tint) => void = () => undefined;

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
    isDraped: boolean,
  ) {
    const compared = scene.models.some((model) => model.surface.difference !== null);
    const colored = scene.models.some((model) => model.hasColors);
    const absent: Partial<Record<Tint, boolean>> = { difference: !compared, ortho: !isDraped, given: !colored };
    for (const tint of TINTS) if (!absent[tint]) this.choice.add(new Option(TITLES[tint], tint));
    this.choice.addEventListener("change", () => {
      this.setTint(this.choice.value as Tint);
      this.chosen(this.tint);
    });
  }

  offers(tint: string): tint is Tint {
    return [...this.choice.options].some(({ value }) => value === tint);
  }

  setTint(tint: Tint): void {
    this.tint = tint;
    this.choice.value = tint;
    for (const model of this.scene.models) model.paint(tint, this.scene.ramps, this.range(tint));
    this.showLegend();
    this.scene.request();
  }

  private range(tint: Tint): [number, number] {
    if (tint === "slope") return [0, STEEPEST];
    if (tint === "aspect") return [0, 360];
    if (tint !== "difference") {
      const [low, high] = this.scene.elevations;
      return high > low ? [low, high] : [low - 0.5, high + 0.5];
    }
    let most = 0;
    for (const { surface } of this.scene.models)
      for (const value of surface.difference ?? []) most = Math.max(most, Math.abs(value));
    return [-most || -1, most || 1];
  }

  private showLegend(): void {
    const shown = this.tint === "ortho" && !this.payload.ortho!.isWhole ? "elevation" : this.tint;
    this.box.hidden = shown === "plain" || shown === "ortho" || shown === "given";
    if (shown === "plain" || shown === "ortho" || shown === "given") return;
    const unit = this.payload.units.elevation;
    const [low, high] = this.range(shown);
    const shift = this.payload.origin[2];
    const digits = Math.min(Math.max(0, 2 - Math.floor(Math.log10(high - low))), 20);
    const elevation = (z: number): string => fix(z + shift, digits);
    const ends: Record<Exclude<Tint, "plain" | "ortho" | "given">, [string, string[]]> = {
      elevation: [joinUnit(this.payload.elevationName, unit), [low, (low + high) / 2, high].map(elevation)],
      slope: ["Slope, degrees", ["0", "15", "30", "45", "60+"]],
      aspect: ["Aspect, facing", ["N", "E", "S", "W", "N"]],
      difference: [joinUnit("Cut (below 0) and fill", unit), [low, 0, high].map((v) => fix(v, digits))],
    };
    const [title, ticks] = ends[shown];
    const basis = find<HTMLElement>("basis");
    basis.hidden = shown !== "difference";
    basis.textContent = this.payload.basis;
    this.box.querySelector("figcaption")!.textContent = title;
    find<HTMLElement>("ramp").style.background =
      `linear-gradient(to right, ${this.payload.ramps[shown].join(", ")})`;
    find<HTMLElement>("ramp").dataset.colors = this.payload.ramps[shown].join(" ");
    // Long numbers have no room beside each other.
    const shownTicks = ticks.join(" ").length > MOST_LETTERS ? [ticks[0], ticks[ticks.length - 1]] : ticks;
    find<HTMLElement>("ticks").replaceChildren(...shownTicks.map((text) => makeText("span", text)));
  }
}
