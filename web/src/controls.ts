// The form: what can be set, as numbers, sliders and lists.

import type { Limits } from "./protocol";
import { type NumberKey, START, type View, WORDS } from "./view";

export type Change = (change: Partial<View>, isMoving: boolean) => void;

type Words = keyof typeof WORDS;

interface Slider {
  key: NumberKey;
  group: string;
  label: string;
  low: number;
  high: number;
  step: number;
  /** Sliders move along this power: 3 gives room to what is low. */
  power?: number;
  /** The word for null and the number that takes its place. */
  none?: string;
  start?: number;
}

interface Choice {
  key: Words;
  label: string;
  names: Record<string, string>;
}

const CHOICES: Choice[] = [
  {
    key: "projection",
    label: "Projection",
    names: { up: "Fish-eye, zenith", side: "Fish-eye, horizon", "lat-long": "Whole sphere", perspective: "Perspective" },
  },
  { key: "quantity", label: "Shows", names: { radiance: "Light", dolp: "Degree of polarisation" } },
  { key: "terrain", label: "Landscape", names: { none: "A plain", ridges: "Ridges to 60 km" } },
  { key: "disc", label: "Sun's disc", names: { hidden: "Hidden", shown: "Shown" } },
  { key: "tone", label: "Tone curve", names: { linear: "Linear", filmic: "Filmic", aces: "ACES" } },
  { key: "compare", label: "Beside it", names: { none: "Nothing", hosek: "Hosek–Wilkie 2012" } },
  { key: "ground", label: "Ground", names: { lit: "In sun and skylight", black: "Black" } },
  { key: "balance", label: "White balance", names: { daylight: "Daylight film", d65: "As measured" } },
];

/** m; of the slider, about where satellites stand still. */
const HIGHEST = 4e7;

function sliders({ altitudes, visibilities }: Limits): Slider[] {
  const [sun, moon, air, picture] = ["sun-controls", "moon-controls", "air-controls", "picture-controls"];
  const last = (list: number[]) => list.at(-1)!;
  return [
    { key: "sunElevation", group: sun, label: "Elevation, °", low: -90, high: 90, step: 0.1 },
    { key: "sunAzimuth", group: sun, label: "Azimuth, °", low: -180, high: 180, step: 0.5 },
    { key: "moonElevation", group: moon, label: "Elevation, °", low: -90, high: 90, step: 0.1, none: "No moon", start: 45 },
    { key: "moonAzimuth", group: moon, label: "Azimuth, °", low: -180, high: 180, step: 0.5 },
    { key: "moonPhase", group: moon, label: "Phase angle, ° (0: full)", low: 0, high: 180, step: 0.5 },
    { key: "visibility", group: air, label: "Visibility, km", low: visibilities[0]! / 1e3, high: last(visibilities) / 1e3, step: 0.1 },
    { key: "altitude", group: air, label: "Altitude, m", low: altitudes[0]!, high: HIGHEST, step: 1, power: 6 },
    { key: "albedo", group: air, label: "Albedo of the ground", low: 0, high: 1, step: 0.01 },
    { key: "exposure", group: picture, label: "Exposure, EV", low: -10, high: 20, step: 0.1, none: "Automatic exposure", start: 13 },
    { key: "polariser", group: picture, label: "Polariser, °", low: -90, high: 90, step: 1, none: "No polariser", start: 0 },
    { key: "divider", group: picture, label: "Divider, % (beside it)", low: 0, high: 100, step: 0.5 },
    { key: "viewAzimuth", group: picture, label: "View azimuth, °", low: -180, high: 180, step: 0.5 },
    { key: "pitch", group: picture, label: "Pitch, ° (perspective)", low: -90, high: 90, step: 0.5 },
    { key: "field", group: picture, label: "Field of view, ° (perspective)", low: 5, high: 150, step: 1 },
  ];
}

function element<K extends keyof HTMLElementTagNameMap>(
  name: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
): HTMLElementTagNameMap[K] {
  return Object.assign(document.createElement(name), properties);
}

export function byId<T extends Element>(id: string, type: abstract new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof type)) throw new Error(`the page has no ${id}`);
  return found;
}

/** A number and a slider for it, and a box that sets it to null. */
class NumberControl {
  readonly #number: HTMLInputElement;
  readonly #range: HTMLInputElement;
  readonly #none: HTMLInputElement | null = null;
  #shown: number | null = NaN;
  #shownAutomatic = NaN;

  constructor(
    private readonly slider: Slider,
    change: Change,
  ) {
    const { key, group, label, low, high, step, none, start } = slider;
    const home = byId(group, HTMLElement);
    this.#number = element("input", { type: "number", id: key, step: "any", min: `${low}`, max: `${high}` });
    this.#range = element("input", { type: "range", id: `${key}-slider`, min: "0", max: "1", step: `${this.#step(step)}` });
    this.#range.setAttribute("aria-label", label);
    const set = (value: number, isMoving: boolean) => change({ [key]: value }, isMoving);
    this.#number.addEventListener("change", () => {
      const value = this.#number.valueAsNumber;
      this.#shown = NaN;
      if (Number.isFinite(value)) set(Math.min(Math.max(value, low), high), false);
      else change({}, false);
    });
    this.#range.addEventListener("input", () => set(this.#value(this.#range.valueAsNumber), true));
    this.#range.addEventListener("change", () => set(this.#value(this.#range.valueAsNumber), false));
    if (none !== undefined) {
      const box = element("input", { type: "checkbox", id: `${key}-none` });
      box.addEventListener("change", () => change({ [key]: box.checked ? null : (start ?? 0) }, false));
      const frame = element("label", { className: "check" });
      frame.append(box, ` ${none}`);
      home.append(frame);
      this.#none = box;
    }
    const frame = element("label");
    frame.append(element("span", { textContent: label }), this.#number);
    home.append(frame, this.#range);
  }

  get isExposure(): boolean {
    return this.slider.key === "exposure";
  }

  /** What stands for null is `automatic`. */
  show(view: View, automatic: number): void {
    const value = view[this.slider.key];
    const shown = value ?? automatic;
    // What stays is not touched: a frame has little time.
    if (value === this.#shown && (value !== null || shown === this.#shownAutomatic)) return;
    this.#shown = value;
    this.#shownAutomatic = shown;
    if (this.#none) this.#none.checked = value === null;
    this.#number.disabled = this.#range.disabled = value === null;
    const text = `${Number(shown.toFixed(3))}`;
    this.#number.value = text;
    const { low, high, power = 1 } = this.slider;
    const share = Math.min(Math.max((shown - low) / (high - low), 0), 1);
    this.#range.value = `${share ** (1 / power)}`;
    this.#range.setAttribute("aria-valuetext", text);
  }

  /** Of a place of the slider, on a step. */
  #value(share: number): number {
    const { low, high, step, power = 1 } = this.slider;
    const value = low + (high - low) * share ** power;
    const even = Number((Math.round(value / step) * step).toFixed(6));
    return Math.min(Math.max(even, low), high);
  }

  /** Of the slider, whose places run from 0 to 1: what a key moves is seen. */
  #step(step: number): number {
    const { low, high, power = 1 } = this.slider;
    return power === 1 ? step / (high - low) : 0.005;
  }
}

export class Controls {
  readonly #numbers: NumberControl[];
  readonly #choices: [Words, HTMLSelectElement][];

  constructor(limits: Limits, change: Change) {
    this.#choices = CHOICES.map(({ key, label, names }) => {
      const list = element("select", { id: key });
      for (const name of WORDS[key]) list.append(new Option(names[name] ?? name, name));
      list.addEventListener("change", () => change({ [key]: list.value }, false));
      const frame = element("label", { className: "wide" });
      frame.append(element("span", { textContent: label }), list);
      byId("picture-controls", HTMLElement).append(frame);
      return [key, list];
    });
    this.#numbers = sliders(limits).map((slider) => new NumberControl(slider, change));
    byId("reset", HTMLButtonElement).addEventListener("click", () => change(START, false));
  }

  /** With the exposure that is automatic now. */
  show(view: View, exposure: number): void {
    for (const [key, list] of this.#choices) if (list.value !== view[key]) list.value = view[key];
    for (const number of this.#numbers) number.show(view, number.isExposure ? exposure : 0);
  }
}
