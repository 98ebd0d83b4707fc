/** Settings: what is shown of the surfaces, and how high. */

import { find, makeSwitch } from "./elements";
import type { Payload } from "./payload";
import { chooseTicks } from "./profile";
import type { TerrainScene } from "./scene";

/** The switches, sliders and numbers of the panel. */
export class Settings {
  private readonly slider = find<HTMLInputElement>("exaggeration");
  private readonly contours = find<HTMLInputElement>("contours");
  private readonly interval = find<HTMLInputElement>("interval");

  constructor(
    payload: Payload,
    private readonly scene: TerrainScene,
  ) {
    for (const place of document.querySelectorAll(".elevation-unit"))
      place.textContent = payload.units.elevation;
    this.contours.checked = payload.interval > 0;
    this.interval.value = String(payload.interval || this.chooseInterval());
    this.fillSurfaces();
    this.fillLayers();
    this.listen();
    this.setExaggeration(payload.exaggeration);
    this.setContours();
  }

  private listen(): void {
    this.slider.addEventListener("input", () => this.setExaggeration(10 ** Number(this.slider.value)));
    this.contours.addEventListener("change", () => this.setContours());
    this.interval.addEventListener("input", () => this.setContours());
    const [edges, shading] = [find<HTMLInputElement>("edges"), find<HTMLInputElement>("shading")];
    edges.addEventListener("change", () => {
      for (const model of this.scene.models) model.showEdges(edges.checked);
      this.scene.request();
    });
    shading.addEventListener("change", () => {
      for (const { material } of this.scene.models)
        material.uniforms.shading.value = shading.checked ? 1 : 0;
      this.scene.request();
    });
    const fold = find<HTMLElement>("fold");
    fold.addEventListener("click", () => {
      const settings = find<HTMLElement>("settings");
      settings.hidden = !settings.hidden;
      fold.setAttribute("aria-expanded", String(!settings.hidden));
    });
  }

  private fillSurfaces(): void {
    const models = this.scene.models;
    const box = find<HTMLFieldSetElement>("surfaces");
    box.hidden = models.length < 2;
    models.forEach((model, k) => {
      model.group.visible = k === models.length - 1;
      box.append(
        makeSwitch(`surface-${k}`, model.surface.data.name, model.group.visible, (shown) => {
          model.group.visible = shown;
          this.scene.request();
        }),
      );
    });
  }

  private fillLayers(): void {
    const box = find<HTMLElement>("layers");
    const kinds = new Map<string, { title: string; color: string }>();
    for (const { surface } of this.scene.models)
      for (const layer of surface.data.lines) kinds.set(layer.kind, layer);
    for (const [kind, layer] of kinds) {
      const toggle = (shown: boolean): void => {
        for (const model of this.scene.models) {
          const object = model.layers.get(kind);
          if (object !== undefined) object.visible = shown;
        }
        this.scene.request();
      };
      box.append(makeSwitch(`layer-${kind}`, layer.title, true, toggle, layer.color));
    }
    if (this.scene.models.every((model) => model.labels === null)) return;
    box.append(
      makeSwitch("points", "Points and labels", false, (shown) => {
        for (const { labels } of this.scene.models) if (labels !== null) labels.marks.visible = shown;
        this.scene.request();
      }),
    );
  }

  private chooseInterval(): number {
    const [low, high] = this.scene.elevations;
    const ticks = chooseTicks(low, high, 24);
    return ticks.length > 1 ? Number((ticks[1] - ticks[0]).toPrecision(6)) : 1;
  }

  setExaggeration(factor: number): void {
    this.slider.max = String(Math.max(2, Math.log10(factor)));
    this.slider.min = String(Math.min(-1, Math.log10(factor)));
    this.slider.value = String(Math.log10(factor));
    this.slider.setAttribute("aria-valuetext", `${Number(factor.toPrecision(3))} times`);
    find<HTMLOutputElement>("factor").value = `\u00d7 ${Number(factor.toPrecision(3))}`;
    this.scene.exaggerate(factor);
  }

  private setContours(): void {
    const shown = this.contours.checked;
    const interval = Number(this.interval.value);
    for (const model of this.scene.models)
      model.material.uniforms.interval.value = shown && interval > 0 ? interval : 0;
    this.scene.request();
  }
}
