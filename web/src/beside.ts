// What stands beside the sky for comparison, and the divider between them.

import { byId, type Change } from "./controls";
import { type Coefficients, Hosek } from "./hosek";
import type { Skies } from "./skies";
import type { View } from "./view";

const RADIANS = Math.PI / 180;

export interface Other {
  coefficients: Coefficients;
  turbidity: number;
}

/** What the other sky depends on; nothing if there is none. */
export function otherKey({ compare, sunElevation, visibility, albedo }: View): string {
  return compare === "none" ? "" : [compare, sunElevation, visibility, albedo].join(" ");
}

export class Beside {
  #model: Hosek | null = null;
  readonly #turbidities = new Map<number, number>();

  constructor(private readonly url: string) {}

  /** In air of the same turbidity; black where the model has no sky, under a sun below the horizon. */
  async of({ compare, sunElevation, visibility, albedo }: View, skies: Skies): Promise<Other | null> {
    if (compare === "none") return null;
    const model = (this.#model ??= await Hosek.load(this.url));
    const turbidity = this.#turbidities.get(visibility) ?? (await skies.turbidity(1e3 * visibility));
    this.#turbidities.set(visibility, turbidity);
    const coefficients = model.coefficients(Math.max(sunElevation, 0) * RADIANS, turbidity, albedo);
    return { coefficients: sunElevation < 0 ? coefficients.fill(0) : coefficients, turbidity };
  }
}

/** The handle on the picture; the slider of the form does the same for the keyboard. */
export class Divider {
  readonly #frame = byId("frame", HTMLElement);
  readonly #handle = byId("divider-handle", HTMLElement);
  #shown = NaN;

  constructor(change: Change) {
    const at = ({ clientX }: PointerEvent) => {
      const { left, width } = this.#frame.getBoundingClientRect();
      return Math.round(Math.min(Math.max((clientX - left) / width, 0), 1) * 1000) / 10;
    };
    this.#handle.addEventListener("pointerdown", (event) => this.#handle.setPointerCapture(event.pointerId));
    this.#handle.addEventListener("pointermove", (event) => {
      if (this.#handle.hasPointerCapture(event.pointerId)) change({ divider: at(event) }, true);
    });
    this.#handle.addEventListener("pointerup", (event) => change({ divider: at(event) }, false));
  }

  show(isThere: boolean, divider: number): void {
    const shown = isThere ? divider : -1;
    if (shown === this.#shown) return;
    this.#shown = shown;
    this.#handle.hidden = !isThere;
    this.#handle.style.left = `${divider}%`;
  }
}
