// What the shader gets: textures and values by the names that it has for them.

import { cameraAxes } from "./directions";
import type { Coefficients } from "./hosek";
import { DISC_ROWS, DISC_TERMS, discBox, discParts, sunDirection } from "./disc";
import type { SkyTables } from "./protocol";
import { AIR_DISTANCES, AIR_HEADER, CELLS, COLUMNS, type Land, RINGS, SUNLIGHT_COLUMNS, SUNLIGHT_ROWS } from "./terrain";
import { BALANCES, PROJECTIONS, QUANTITIES, type View } from "./view";

const RADIANS = Math.PI / 180;

/** A texture of floats, as many to a texel as there are. */
export interface Texels {
  width: number;
  height: number;
  values: Float32Array;
}

export type Textures = Record<string, Texels>;
/** Numbers by name; truth is 1. */
export type Values = Record<string, readonly number[] | Float32Array>;

export const channelsOf = ({ width, height, values }: Texels) => values.length / (width * height);

/** What the sky is lit by, or the air seen from outside. */
export type Source = "sun" | "moon" | "space";

/** From outside of the air: how far away, of the distance of where rays enter it, from the planet's centre. */
export type Eye = number | null;

const NAMES = {
  sun: { root: "roots", degrees: "degrees" },
  moon: { root: "moon_roots", degrees: "moon_degrees" },
} as const;

export function skyTextures(source: Source, tables: SkyTables): Textures {
  if (source !== "space") return lightTextures(NAMES[source], tables);
  const columns = tables.header[9]! + 1;
  return { space_roots: { width: columns, height: tables.root.length / 4 / columns, values: tables.root } };
}

function lightTextures(names: (typeof NAMES)["sun" | "moon"], { header, root, degrees, disc, air }: SkyTables): Textures {
  const [rows, columns] = [header[7]! + header[8]! + 2, header[9]! + 1];
  const textures: Textures = { [names.root]: { width: columns, height: rows, values: root } };
  if (degrees) textures[names.degrees] = { width: 2 * columns, height: rows, values: degrees };
  if (disc) textures["disc"] = { width: DISC_TERMS, height: DISC_ROWS, values: disc.subarray(4) };
  if (air) {
    const [airRows, airColumns] = [air.header[3]!, air.header[4]!];
    textures["air"] = { width: 2 * airColumns, height: airRows * AIR_DISTANCES, values: air.table };
    textures["sunlight"] = { width: SUNLIGHT_COLUMNS, height: SUNLIGHT_ROWS, values: air.sunlight };
  }
  return textures;
}

/** What changed of the landscape. */
export function landTextures({ slopes, normals, shadows }: Land): Textures {
  const textures: Textures = {};
  if (slopes) textures["slopes"] = { width: COLUMNS, height: RINGS, values: slopes };
  if (normals) textures["normals"] = { width: COLUMNS, height: RINGS, values: normals };
  if (shadows) textures["shadows"] = { width: CELLS, height: CELLS, values: shadows };
  return textures;
}

export interface Picture {
  view: View;
  tables: ReadonlyMap<Source, SkyTables>;
  eye: Eye;
  /** What stands to the right of the divider. */
  other: Coefficients | null;
  hasLand: boolean;
  width: number;
  height: number;
  /** Luminance of white, cd m⁻². */
  white: number;
  /** Place of the tone curve; −1 leaves light as it is. */
  tone: number;
}

const NONE = new Float32Array(12);

export function values(picture: Picture): Values {
  const { view, tables, eye, width, height } = picture;
  const hasDegrees = eye === null && [...tables.values()].some(({ degrees }) => degrees !== null);
  return {
    size: [width, height],
    projection: [PROJECTIONS.indexOf(view.projection)],
    axes: cameraAxes(view).flat(),
    half_field: [Math.tan((view.field * RADIANS) / 2)],
    quantity: [hasDegrees ? QUANTITIES.indexOf(view.quantity) : 0],
    has_polariser: [Number(hasDegrees && view.polariser !== null)],
    polariser: [(view.polariser ?? 0) * RADIANS],
    white: [picture.white],
    tone: [picture.tone],
    is_daylight: [Number(BALANCES[0] === view.balance)],
    ...lightValues("sun", tables.get("sun"), view.sunAzimuth),
    ...lightValues("moon", tables.get("moon"), view.moonAzimuth),
    ...spaceValues(picture),
    ...otherValues(picture),
    ...discValues(picture),
    ...landValues(picture),
  };
}

function lightValues(name: "sun" | "moon", tables: SkyTables | undefined, azimuth: number): Values {
  const h = tables?.header ?? NONE;
  return {
    [`${name}_horizon`]: h.subarray(0, 4),
    [`${name}_ends`]: h.subarray(4, 7),
    [`${name}_intervals`]: [h[7]!, h[8]!, h[9]!],
    [`${name}_azimuth`]: [Math.cos(azimuth * RADIANS), Math.sin(azimuth * RADIANS)],
  };
}

function spaceValues({ view, tables, eye }: Picture): Values {
  const h = tables.get("space")?.header ?? NONE;
  return {
    is_beyond: [Number(eye !== null)],
    eye: [eye ?? 1],
    space_sun: sunDirection(view),
    space_ends: h.subarray(0, 4),
    space_layers: h.subarray(4, 6),
    space_counts: [h[6]!, h[7]!, h[8]!],
    space_columns: [h[9]!],
  };
}

const NO_OTHER = new Float32Array(40);

function otherValues({ view, eye, other }: Picture): Values {
  const isSplit = view.compare === "hosek" && other !== null && eye === null;
  return { divider: [isSplit ? view.divider / 100 : 2], hosek: other ?? NO_OTHER, hosek_sun: sunDirection(view) };
}

function discValues({ view, tables, width, height }: Picture): Values {
  const { disc = null, header } = tables.get("sun") ?? {};
  if (!disc) return { disc_axis: [0, 0, 0, 1], disc_sun: [0, 0, 1], disc_box: [0, 0, 0, 0], disc_parts: [1] };
  const sun = sunDirection(view, header?.[10]);
  const box = discBox(view, sun);
  return {
    disc_axis: [disc[0]!, disc[1]!, disc[2]!, disc[3]!],
    disc_sun: sun,
    disc_box: box.map((edge, i) => ((edge + 1) / 2) * (i % 2 === 0 ? width : height)),
    disc_parts: [discParts(box, width, height)],
  };
}

function landValues({ view, tables, hasLand }: Picture): Values {
  const { air = null, header } = tables.get("sun") ?? {};
  const land = new Float32Array(AIR_HEADER);
  if (air) land.set(air.header);
  land[18] = Number(air !== null && hasLand);
  land[19] = Number(view.ground === "lit");
  return { land, land_sun: sunDirection(view, header?.[10]) };
}
