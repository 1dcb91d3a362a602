// What the page shows, and the link that says so.

export const PROJECTIONS = ["up", "side", "lat-long", "perspective"] as const;
export const QUANTITIES = ["radiance", "dolp"] as const;
export const TONES = ["linear", "filmic", "aces"] as const;
export const GROUNDS = ["lit", "black"] as const;
export const OTHERS = ["none", "hosek"] as const;
export const DISCS = ["hidden", "shown"] as const;
export const TERRAINS = ["none", "ridges"] as const;
export const BALANCES = ["daylight", "d65"] as const;

export type Projection = (typeof PROJECTIONS)[number];

/** Angles are in degrees here, as people enter them. */
export interface View {
  sunElevation: number;
  sunAzimuth: number;
  /** None if null. */
  moonElevation: number | null;
  moonAzimuth: number;
  /** Between sun and observer as seen from the moon: 0 is full. */
  moonPhase: number;
  /** km */
  visibility: number;
  /** m */
  altitude: number;
  albedo: number;
  ground: (typeof GROUNDS)[number];
  disc: (typeof DISCS)[number];
  terrain: (typeof TERRAINS)[number];
  /** EV at ISO 100; automatic if null. */
  exposure: number | null;
  projection: Projection;
  viewAzimuth: number;
  pitch: number;
  field: number;
  quantity: (typeof QUANTITIES)[number];
  /** From the top of the picture to the right; none if null. */
  polariser: number | null;
  /** What stands beside the sky, to the right of the divider. */
  compare: (typeof OTHERS)[number];
  /** % of the width. */
  divider: number;
  tone: (typeof TONES)[number];
  balance: (typeof BALANCES)[number];
  /** Height of the picture in pixels; as large as it is shown if null. */
  size: number | null;
}

export const START: View = {
  sunElevation: 20,
  sunAzimuth: 0,
  moonElevation: null,
  moonAzimuth: 0,
  moonPhase: 1.55,
  visibility: 59.4,
  altitude: 0,
  albedo: 0.2,
  ground: "lit",
  disc: "hidden",
  terrain: "none",
  exposure: null,
  projection: "up",
  viewAzimuth: 0,
  pitch: 10,
  field: 60,
  quantity: "radiance",
  polariser: null,
  compare: "none",
  divider: 50,
  tone: "aces",
  balance: "daylight",
  size: null,
};

/** The keys of numbers. */
export type NumberKey = { [K in keyof View]: View[K] extends number | null ? K : never }[keyof View];

/** What is allowed whatever the model: the model's own ranges are narrower for some. */
export const BOUNDS: Record<NumberKey, readonly [low: number, high: number]> = {
  sunElevation: [-90, 90],
  sunAzimuth: [-360, 360],
  moonElevation: [-90, 90],
  moonAzimuth: [-360, 360],
  moonPhase: [0, 180],
  visibility: [1, 1000],
  altitude: [0, 5e8],
  albedo: [0, 1],
  exposure: [-60, 60],
  viewAzimuth: [-360, 360],
  pitch: [-90, 90],
  field: [1, 170],
  polariser: [-180, 180],
  divider: [0, 100],
  size: [16, 2048],
};

/** The keys of words, and which there are. */
export const WORDS = {
  projection: PROJECTIONS,
  quantity: QUANTITIES,
  tone: TONES,
  balance: BALANCES,
  ground: GROUNDS,
  compare: OTHERS,
  disc: DISCS,
  terrain: TERRAINS,
} as const;

/** The part of an address after #, with what differs from the start. */
export function toHash(view: View): string {
  const parts = Object.entries(view).filter(([key, value]) => value !== START[key as keyof View] && value !== null);
  return parts.map(([key, value]) => `${key}=${value}`).join("&");
}

/** The view of such a part; what makes no sense is left out, and named. */
export function fromHash(hash: string): { view: View; wrong: string[] } {
  const view: Record<string, unknown> = { ...START };
  const wrong: string[] = [];
  for (const [key, text] of new URLSearchParams(hash.replace(/^#/, ""))) {
    const value = Object.hasOwn(WORDS, key) ? word(key as keyof typeof WORDS, text) : number(key, text);
    if (value === undefined) wrong.push(`${key}=${text}`);
    else view[key] = value;
  }
  return { view: view as unknown as View, wrong };
}

function word(key: keyof typeof WORDS, text: string): string | undefined {
  return (WORDS[key] as readonly string[]).find((name) => name === text);
}

function number(key: string, text: string): number | undefined {
  const bounds = Object.hasOwn(BOUNDS, key) ? BOUNDS[key as NumberKey] : undefined;
  const value = text.trim() === "" ? NaN : Number(text);
  return bounds && value >= bounds[0] && value <= bounds[1] ? value : undefined;
}
