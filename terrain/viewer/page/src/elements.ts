/** Elements of the page, and words in them. */

export function find<T extends Element>(id: string): T {
  const element = document.getElementById(id);
  if (element === null) throw new Error(`the page has no element '${id}'`);
  return element as unknown as T;
}

/** Write a number with so many decimals, and nought without a minus. */
export function fix(value: number, decimals: number): string {
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text;
}

export function joinUnit(words: string, unit: string): string {
  return unit === "" ? words : `${words}, ${unit}`;
}

export function makeText(tag: string, text: string, color = ""): HTMLElement {
  const element = document.createElement(tag);
  element.textContent = text;
  if (color !== "") element.style.color = color;
  return element;
}

export function makeSwitch(
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

/** Say words to a screen reader; they are not seen. */
export function tell(words: string): void {
  find<HTMLElement>("told").textContent = words;
}

/** Whether the screen is that of a phone: the same as in the style sheet. */
export function isSmallScreen(): boolean {
  return matchMedia("(max-width: 760px), (max-height: 500px)").matches;
}

/** Offer a text or an address as a file, by the title of the page and a suffix. */
export function offerFile(title: string, suffix: string, address: string): void {
  const link = document.createElement("a");
  link.download = `${title.replace(/[^\p{L}\p{N} _-]+/gu, "").slice(0, 80) || "terrain"}${suffix}`;
  link.href = address;
  link.click();
}
