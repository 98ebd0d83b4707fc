/** Two surfaces side by side, and the slider between them. */

import { find } from "./elements";
import type { Settings } from "./settings";
import type { Model, TerrainScene } from "./scene";

/** The switch, the choice of both surfaces, and the slider over the view. */
export class Comparison {
  private readonly switch = find<HTMLInputElement>("comparing");
  private readonly sides = [find<HTMLSelectElement>("left"), find<HTMLSelectElement>("right")] as const;
  private readonly slider = find<HTMLInputElement>("split");
  private readonly box = find<HTMLElement>("swipe");

  constructor(
    private readonly scene: TerrainScene,
    private readonly settings: Settings,
  ) {
    const { models } = scene;
    find<HTMLElement>("comparison").hidden = models.length < 2;
    if (models.length < 2) return;
    const last = models.filter((model) => model.surface.difference === null).length - 1;
    this.sides.forEach((side, k) => {
      models.forEach((model, m) => side.add(new Option(model.surface.data.name.slice(0, 80), String(m))));
      side.value = String(k === 0 ? 0 : last);
      side.addEventListener("change", () => this.show());
    });
    this.switch.addEventListener("change", () => this.show());
    this.slider.addEventListener("input", () => this.show());
    scene.drawn.push(() => this.place());
    this.show();
  }

  private show(): void {
    const isOn = this.switch.checked;
    const [left, right] = this.sides.map((side): Model => this.scene.models[Number(side.value)]);
    this.scene.split = isOn ? { share: Number(this.slider.value) / 100, left, right } : null;
    this.settings.allowSurfaces(!isOn);
    for (const side of this.sides) side.disabled = !isOn;
    this.box.hidden = !isOn;
    find<HTMLElement>("before").textContent = left.surface.data.name;
    find<HTMLElement>("after").textContent = right.surface.data.name;
    const names = [left, right].map(({ surface }) => surface.data.name.slice(0, 80));
    this.slider.setAttribute(
      "aria-valuetext",
      `${this.slider.value} percent: ${names[0]} to the left of it, ${names[1]} to the right`,
    );
    this.scene.request();
  }

  /** Put the border where the scene has it. */
  private place(): void {
    if (!this.box.hidden) this.box.style.setProperty("--at", `${this.scene.border}px`);
  }

  write(view: URLSearchParams): void {
    if (!this.switch.checked) return;
    const sides = this.sides.map((side) => Number(side.value) + 1);
    view.set("split", [this.slider.value, ...sides].join(","));
  }

  /** Show what a link says: percent from the left, and the numbers of both surfaces. */
  read(given: number[] | null): void {
    const count = this.scene.models.length;
    if (count < 2) return;
    this.switch.checked = given !== null;
    if (given !== null) {
      this.slider.value = String(given[0]);
      this.sides.forEach((side, k) => (side.value = String(given[k + 1] - 1)));
    }
    this.show();
  }
}
