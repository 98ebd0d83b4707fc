/** The view in the fragment of the address: so a link opens the page as it was seen. */

import type { Comparison } from "./comparison";
import { find, fix, makeText, tell } from "./elements";
import type { Legend } from "./legend";
import { type Tint, TINTS } from "./material";
import type { Payload } from "./payload";
import type { Standpoint, TerrainScene } from "./scene";
import type { Settings } from "./settings";

/** Milliseconds after which a view that has not changed is written. */
const REST = 400;
const KEYS = ["at", "from", "exaggeration", "colour", "show", "hide", "contours", "shading", "edges", "points", "split"];

/** A part of a fragment that cannot be read. */
class Unreadable extends Error {}

/** The address of the page, and the button that copies it. */
export class Link {
  private timer = 0;
  private written: string;
  private readonly startTint: Tint;
  /** In a notebook the page has no address of its own. */
  private readonly hasAddress = /^(file|https?):$/.test(location.protocol);

  constructor(
    private readonly payload: Payload,
    private readonly scene: TerrainScene,
    private readonly parts: { legend: Legend; settings: Settings; comparison: Comparison },
  ) {
    const button = find<HTMLElement>("link");
    button.hidden = !this.hasAddress;
    button.addEventListener("click", () => void this.copy());
    window.addEventListener("hashchange", () => this.open());
    this.startTint = parts.legend.tint;
    this.open();
    this.written = this.format();
    scene.drawn.push(() => this.note());
  }

  private note(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.write(), REST);
  }

  private write(): void {
    const text = this.format();
    if (!this.hasAddress || text === this.written) return;
    this.written = text;
    try {
      history.replaceState(null, "", `#${text}`);
    } catch {
      // A browser that allows no change of the address here still copies the link.
    }
  }

  /** Return the address of the present view. */
  get address(): string {
    return `${location.href.split("#")[0]}#${this.format()}`;
  }

  private async copy(): Promise<void> {
    this.write();
    const { address } = this;
    const isCopied = await copyText(address);
    const words = isCopied ? "The link to this view was copied." : `The link to this view: ${address}`;
    find<HTMLElement>("readout").textContent = words;
  }

  format(): string {
    const { origin, scale, axes, decimals, geographic } = this.payload;
    const { target, azimuth, tilt, away } = this.scene.standpoint;
    const digits = geographic ? 7 : decimals[0];
    const view = new URLSearchParams();
    view.set("from", `${fix(azimuth, 2)},${fix(tilt, 2)}`);
    if (!this.scene.isWhole) view.set("from", `${view.get("from")},${Number(away.toPrecision(6))}`);
    const place = [0, 1].map((k) => fix(axes[k][1] * (target[k] / scale[k] + origin[k]), digits));
    if (!this.scene.isWhole) view.set("at", [...place, fix(target[2] + origin[2], decimals[1])].join(","));
    view.set("colour", this.parts.legend.tint);
    this.parts.settings.write(view);
    this.parts.comparison.write(view);
    return view.toString().replace(/%2C/g, ",");
  }

  /** Show what the address says; what it does not say is as at the start. */
  open(): void {
    const given = new URLSearchParams(location.hash.slice(1));
    if (!KEYS.some((key) => given.has(key))) return;
    document.getElementById("unreadable")?.remove();
    try {
      this.apply(given);
    } catch (error) {
      if (!(error instanceof Unreadable)) throw error;
      const words = `The view in the address cannot be shown: ${error.message}`;
      const note = makeText("p", words);
      note.id = "unreadable";
      find<HTMLElement>("remarks").before(note);
      tell(words);
    }
  }

  /** Check all that is given before any of it is shown. */
  private apply(given: URLSearchParams): void {
    const { legend, settings, comparison } = this.parts;
    const count = this.scene.models.length;
    const colour = given.get("colour");
    if (colour !== null && !legend.offers(colour))
      throw new Unreadable(`'colour' is '${colour.slice(0, 40)}', and must be one of ${TINTS.join(", ")}.`);
    const standpoint = this.readStandpoint(given);
    const split = given.has("split") ? readNumbers(given, "split", 3) : null;
    const isSurface = (k: number): boolean => Number.isInteger(k) && k >= 1 && k <= count;
    if (split !== null && !(split[0] >= 0 && split[0] <= 100 && isSurface(split[1]) && isSurface(split[2])))
      throw new Unreadable(`'split' must be a percentage and the numbers of two surfaces, 1 to ${count}.`);
    const shown = given.has("show") ? readNumbers(given, "show") : null;
    if (shown !== null && !shown.every(isSurface))
      throw new Unreadable(`'show' must be numbers of surfaces, 1 to ${count}.`);
    const exaggeration = given.has("exaggeration") ? readNumbers(given, "exaggeration", 1)[0] : null;
    const contours = given.has("contours") ? readNumbers(given, "contours", 1)[0] : null;
    if ((exaggeration !== null && exaggeration <= 0) || (contours !== null && contours < 0))
      throw new Unreadable("'exaggeration' and 'contours' must be above 0.");
    legend.setTint((colour as Tint | null) ?? this.startTint);
    settings.read(given, { exaggeration, contours, shown });
    comparison.read(split);
    if (Array.isArray(standpoint)) this.scene.look(...standpoint);
    else if (standpoint !== null) this.scene.standpoint = standpoint;
  }

  /** Return a place of the camera, or a direction from which all of the terrain is seen. */
  private readStandpoint(given: URLSearchParams): Standpoint | [number, number] | null {
    if (!given.has("at") && !given.has("from")) return null;
    const { origin, scale, axes } = this.payload;
    const [azimuth, tilt, away] = readNumbers(given, "from", given.has("at") ? 3 : 2);
    if (tilt < 0 || tilt > 90 || away <= 0)
      throw new Unreadable("'from' must be azimuth, degrees above the horizon (0 to 90) and, with 'at', distance.");
    if (!given.has("at")) return [azimuth, tilt];
    const [x, y, z] = readNumbers(given, "at", 3);
    const place = [x, y].map((value, k) => (value * axes[k][1] - origin[k]) * scale[k]);
    return { target: [place[0], place[1], z - origin[2]], azimuth, tilt, away };
  }
}

function readNumbers(given: URLSearchParams, key: string, count?: number): number[] {
  const text = given.get(key) ?? "";
  const numbers = text === "" ? [] : text.split(",").map((part) => (part.trim() === "" ? NaN : Number(part)));
  if (!numbers.every(Number.isFinite) || (count !== undefined && numbers.length !== count))
    throw new Unreadable(`'${key}' is '${text.slice(0, 40)}', and must be ${count === 1 ? "a number" : `${count ?? "some"} numbers with commas`}.`);
  return numbers;
}

async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // Where the clipboard is not open to pages, a selection can still be copied.
    const area = document.createElement("textarea");
    area.value = text;
    area.className = "unseen";
    document.body.append(area);
    area.select();
    const isCopied = document.execCommand("copy");
    area.remove();
    return isCopied;
  }
}
