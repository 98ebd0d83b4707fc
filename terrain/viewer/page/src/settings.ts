/** Settings: what is shown of the surfaces, and how high. */

import { find, isSmallScreen, makeSwitch } from "./elements";
import type { Legend } from "./legend";
import type { Payload } from "./payload";
import { chooseTicks } from "./measure/profile";
import type { Model, TerrainScene } from "./scene";

/** Letters of notes that are open at the start: more would lie over the terrain. */
const MOST_REMARKS = 360;

/** The switches, sliders and numbers of the panel. */
export class Settings {
  private readonly slider = find<HTMLInputElement>("exaggeration");
  private readonly contours = find<HTMLInputElement>("contours");
  private readonly interval = find<HTMLInputElement>("interval");
  private readonly edges = find<HTMLInputElement>("edges");
  private readonly shading = find<HTMLInputElement>("shading");
  /** Of each kind of lines, and of points if there are any. */
  private readonly boxes = new Map<string, HTMLInputElement>();
  private points: HTMLInputElement | null = null;
  private shownBefore: Model[] | null = null;
  private factor = 1;

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
    legend: Legend,
  ) {
    legend.chosen = (tint) => this.showDifference(tint === "difference");
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
    const { edges, shading } = this;
    edges.addEventListener("change", () => {
      for (const model of this.scene.models) model.showEdges(edges.checked);
      this.scene.request();
    });
    shading.addEventListener("change", () => {
      for (const { material } of this.scene.models)
        material.uniforms.shading.value = shading.checked ? 1 : 0;
      this.scene.request();
    });
    find<HTMLElement>("fold").addEventListener("click", () => this.fold(!find<HTMLElement>("settings").hidden));
    const remarks = find<HTMLDetailsElement>("remarks");
    remarks.open = !isSmallScreen() && (remarks.textContent ?? "").length <= MOST_REMARKS;
    if (isSmallScreen()) this.fold(true);
  }

  private fold(isFolded: boolean): void {
    find<HTMLElement>("settings").hidden = isFolded;
    find<HTMLElement>("fold").setAttribute("aria-expanded", String(!isFolded));
  }

  private fillSurfaces(): void {
    const models = this.scene.models;
    const box = find<HTMLFieldSetElement>("surfaces");
    box.hidden = models.length < 2;
    models.forEach((model, k) => {
      box.append(
        makeSwitch(`surface-${k}`, model.surface.data.name, false, (shown) => {
          model.group.visible = shown;
          this.scene.request();
        }),
      );
    });
    this.showSurfaces(this.firstShown);
  }

  /** At the start the last of the surfaces is shown; what tells cut and fill is another once more. */
  private get firstShown(): Model[] {
    return this.scene.models.filter(({ surface }) => surface.difference === null).slice(-1);
  }

  showSurfaces(shown: Model[]): void {
    this.scene.models.forEach((model, k) => {
      model.group.visible = shown.includes(model);
      find<HTMLInputElement>(`surface-${k}`).checked = model.group.visible;
    });
    this.scene.request();
  }

  allowSurfaces(isAllowed: boolean): void {
    find<HTMLFieldSetElement>("surfaces").disabled = !isAllowed;
  }

  /** Show cut and fill where their colours are chosen, and before what was shown again after it. */
  private showDifference(isShown: boolean): void {
    const { models } = this.scene;
    const visible = models.filter((model) => model.group.visible);
    const different = models.filter(({ surface }) => surface.difference !== null);
    if (isShown && !visible.some((model) => different.includes(model))) {
      this.shownBefore = visible;
      this.showSurfaces(different.slice(-1));
    } else if (!isShown && this.shownBefore !== null) {
      if (visible.every((model) => different.includes(model))) this.showSurfaces(this.shownBefore);
      this.shownBefore = null;
    }
  }

  write(view: URLSearchParams): void {
    view.set("exaggeration", String(Number(this.factor.toPrecision(4))));
    const { models } = this.scene;
    if (models.length > 1)
      view.set("show", models.flatMap((model, k) => (model.group.visible ? [k + 1] : [])).join(","));
    const hidden = [...this.boxes].filter(([, box]) => !box.checked).map(([kind]) => kind);
    if (hidden.length > 0) view.set("hide", hidden.join(","));
    if (this.contours.checked) view.set("contours", this.interval.value);
    if (!this.shading.checked) view.set("shading", "0");
    if (this.edges.checked) view.set("edges", "1");
    if (this.points?.checked) view.set("points", "1");
  }

  /** Show what a link says, checked before; what it does not say is as at the start. */
  read(given: URLSearchParams, numbers: { exaggeration: number | null; contours: number | null; shown: number[] | null }): void {
    this.setExaggeration(numbers.exaggeration ?? this.payload.exaggeration);
    const interval = numbers.contours ?? 0;
    if (interval > 0) this.interval.value = String(interval);
    const { models } = this.scene;
    this.shownBefore = null;
    this.showSurfaces(numbers.shown?.map((k) => models[k - 1]) ?? this.firstShown);
    const hidden = (given.get("hide") ?? "").split(",");
    set(this.contours, interval > 0);
    set(this.shading, given.get("shading") !== "0");
    set(this.edges, given.get("edges") === "1");
    if (this.points !== null) set(this.points, given.get("points") === "1");
    for (const [kind, box] of this.boxes) set(box, !hidden.includes(kind));
    this.setContours();
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
      this.boxes.set(kind, find<HTMLInputElement>(`layer-${kind}`));
    }
    if (this.scene.models.every((model) => model.labels === null)) return;
    box.append(
      makeSwitch("points", "Points and labels", false, (shown) => {
        for (const { labels } of this.scene.models) if (labels !== null) labels.marks.visible = shown;
        this.scene.request();
      }),
    );
    this.points = find<HTMLInputElement>("points");
  }

  private chooseInterval(): number {
    const [low, high] = this.scene.elevations;
    const ticks = chooseTicks(low, high, 24);
    return ticks.length > 1 ? Number((ticks[1] - ticks[0]).toPrecision(6)) : 1;
  }

  setExaggeration(factor: number): void {
    this.factor = factor;
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

/** Set a switch as a click would. */
function set(box: HTMLInputElement, checked: boolean): void {
  if (box.checked !== checked) box.click();
}
