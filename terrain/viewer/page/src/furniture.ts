/** Furniture of the map: labels, scale bar, north arrow, and the picture of them all. */

import { chooseBar, drawCross, drawLabels, drawLegend, drawMeasured, drawNorth, drawRoute } from "./annotations";
import { find, offerFile } from "./elements";
import type { Legend } from "./legend";
import type { Payload } from "./payload";
import type { TerrainScene } from "./scene";
import type { Theme } from "./theme";
import type { Tool } from "./measure/tool";

/** What is drawn over the 3D view, each time that it is drawn. */
export class Furniture {
  private readonly notes = find<HTMLCanvasElement>("notes");
  private readonly bar = find<HTMLElement>("bar");
  private readonly north = find<SVGElement>("north");

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
    private readonly theme: Theme,
    private readonly legend: Legend,
    private readonly tool: Tool,
  ) {
    scene.drawn.push(() => this.annotate());
    find<HTMLElement>("picture").addEventListener("click", () => this.savePicture());
    window.addEventListener("beforeprint", () => this.preparePrint());
    window.addEventListener("afterprint", () => document.getElementById("printed")?.remove());
    new ResizeObserver(() => this.resize()).observe(scene.canvas);
    this.resize();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.scene.canvas;
    if (width === 0 || height === 0) return;
    this.scene.resize(width, height);
    const ratio = Math.min(window.devicePixelRatio, 2);
    this.notes.width = width * ratio;
    this.notes.height = height * ratio;
  }

  private annotate(): void {
    const pen = this.notes.getContext("2d");
    if (pen === null) return;
    const ratio = this.notes.width / this.scene.canvas.clientWidth;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.scene.canvas.clientWidth, this.scene.canvas.clientHeight);
    const { ink, halo } = this.theme.colors;
    drawLabels(pen, this.scene, ink, halo);
    const { measured } = this.payload.colors;
    if (this.tool.tool === "along") drawRoute(pen, this.scene, this.tool.marked, this.tool.path, measured);
    else drawMeasured(pen, this.scene, this.tool.marked, this.tool.tool === "area", measured);
    if (this.scene.canvas.matches(":focus-visible")) drawCross(pen, this.scene.canvas, ink, halo);
    this.north.querySelector("g")!.setAttribute("transform", `rotate(${-this.scene.heading})`);
    const [length, pixels] = chooseBar(this.scene.unitsPerPixel, 140);
    this.bar.querySelector("span")!.textContent = `${Number(length.toPrecision(6))} ${this.payload.units.horizontal}`.trim();
    this.bar.querySelector("i")!.style.width = `${pixels}px`;
  }

  private savePicture(): void {
    offerFile(this.payload.title, ".png", this.takePicture());
  }

  /** Put a picture in the place of the view: what WebGL has drawn is gone when a page is printed. */
  private preparePrint(): void {
    document.getElementById("printed")?.remove();
    const picture = this.drawPicture();
    picture.id = "printed";
    this.scene.canvas.parentElement!.append(picture);
  }

  /** Return the present view with its annotations as a PNG in a data URL. */
  takePicture(): string {
    return this.drawPicture().toDataURL("image/png");
  }

  private drawPicture(): HTMLCanvasElement {
    this.scene.draw();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [this.scene.canvas.width, this.scene.canvas.height];
    const pen = canvas.getContext("2d")!;
    pen.drawImage(this.scene.canvas, 0, 0);
    pen.drawImage(this.notes, 0, 0, canvas.width, canvas.height);
    const ratio = canvas.width / this.scene.canvas.clientWidth;
    pen.scale(ratio, ratio);
    pen.fillStyle = this.theme.colors.ink;
    pen.font = "600 20px system-ui, sans-serif";
    pen.fillText(this.payload.title, 16, 32, this.scene.canvas.clientWidth - 32);
    pen.font = "14px system-ui, sans-serif";
    const width = this.bar.querySelector("i")!.getBoundingClientRect().width;
    pen.fillRect(16, this.scene.canvas.clientHeight - 24, width, 3);
    pen.fillText(`${this.bar.querySelector("span")!.textContent ?? ""}, ${this.payload.crs}`, 16, this.scene.canvas.clientHeight - 32);
    if (!this.legend.box.hidden) drawLegend(pen, this.legend.box, this.scene.canvas);
    drawNorth(pen, this.scene.canvas.clientWidth - 40, 40, this.scene.heading);
    return canvas;
  }
}
