/** Light or dark: the colours of the page. */

import { find } from "./elements";
import type { Payload, ThemeColors } from "./payload";
import type { TerrainScene } from "./scene";

/** The theme, and its button; `changed` is called after each change. */
export class Theme {
  name: "light" | "dark" = "light";
  changed: () => void = () => {};
  private readonly button = find<HTMLButtonElement>("theme");

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
  ) {
    this.button.addEventListener("click", () => this.set(this.name === "light"));
    this.set(matchMedia("(prefers-color-scheme: dark)").matches);
  }

  get colors(): ThemeColors {
    return this.payload.colors.themes[this.name];
  }

  set(dark: boolean): void {
    this.name = dark ? "dark" : "light";
    document.documentElement.dataset.theme = this.name;
    this.button.setAttribute("aria-pressed", String(dark));
    this.scene.setBackground(this.colors.ground);
    this.changed();
  }
}
