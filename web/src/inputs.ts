// What the shader gets: textures and values by the names that it has for them.

import { cameraAxes } from "./directions";
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

export function skyTextures({ header, root, degrees, disc, air }: SkyTables): Textures {
  const [rows, columns] = [header[7]! + header[8]! + 2, header[9]! + 1];
  const textures: Textures = { roots: { width: columns, height: rows, values: root } };
  if (degrees) textures["degrees"] = { width: 2 * columns, height: rows, values: degrees };
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
  tables: SkyTables;
  hasLand: boolean;
  width: number;
  height: number;
  /** Luminance of white, cd m⁻². */
  white: number;
  /** Place of the tone curve; −1 leaves light as it is. */
  tone: number;
}

export function values(picture: Picture): Values {
  const { view, tables, width, height } = picture;
  const h = tables.header;
  const hasDegrees = tables.degrees !== null;
  return {
    size: [width, height],
    projection: [PROJECTIONS.indexOf(view.projection)],
    axes: cameraAxes(view).flat(),
    half_field: [Math.tan((view.field * RADIANS) / 2)],
    horizon: [h[0]!, h[1]!, h[2]!, h[3]!],
    ends: [h[4]!, h[5]!, h[6]!],
    intervals: [h[7]!, h[8]!, h[9]!],
    sun: [Math.cos(view.sunAzimuth * RADIANS), Math.sin(view.sunAzimuth * RADIANS)],
    quantity: [hasDegrees ? QUANTITIES.indexOf(view.quantity) : 0],
    has_polariser: [Number(hasDegrees && view.polariser !== null)],
    polariser: [(view.polariser ?? 0) * RADIANS],
    white: [picture.white],
    tone: [picture.tone],
    is_daylight: [Number(BALANCES[0] === view.balance)],
    ...discValues(picture),
    ...landValues(picture),
  };
}

function discValues({ view, tables: { disc, header }, width, height }: Picture): Values {
  const sun = sunDirection(view, header[10]);
  const box = discBox(view, sun);
  return {
    disc_axis: disc ? [disc[0]!, disc[1]!, disc[2]!, disc[3]!] : [0, 0, 0, 1],
    disc_sun: sun,
    disc_box: box.map((edge, i) => ((edge + 1) / 2) * (i % 2 === 0 ? width : height)),
    disc_parts: [discParts(box, width, height)],
  };
}

function landValues({ view, tables: { air, header }, hasLand }: Picture): Values {
  const land = new Float32Array(AIR_HEADER);
  if (air) land.set(air.header);
  land[18] = Number(air !== null && hasLand);
  land[19] = Number(view.ground === "lit");
  return { land, land_sun: sunDirection(view, header[10]) };
}
