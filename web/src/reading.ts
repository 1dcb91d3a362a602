// What is under the pointer: numbers and a chart.

import type { Vector } from "./directions";
import type { Spectrum } from "./protocol";

const [WIDTH, HEIGHT, MARGIN] = [320, 120, 18];
const LOWEST = 300;
const HIGHEST = 1100;

interface Row {
  wavelength: number;
  radiance: number;
  degree: number;
  angle: number;
}

function rows(spectrum: Spectrum): Row[] {
  return Array.from({ length: spectrum.length / 4 }, (_, i) => {
    const [wavelength, radiance, q, u] = [0, 1, 2, 3].map((k) => spectrum[4 * i + k]!) as [number, number, number, number];
    const angle = ((Math.atan2(u, q) / 2) * 180) / Math.PI;
    const degree = radiance > 0 ? Math.min(Math.hypot(q, u) / radiance, 1) : 0;
    return { wavelength, radiance, degree, angle };
  });
}

/** Where somebody looks, and the light at the wavelength next to 550 nm. */
export function describe([x, y, z]: Vector, spectrum: Spectrum): string {
  const degrees = (angle: number) => `${((angle * 180) / Math.PI).toFixed(1)}°`;
  const where = `Elevation ${degrees(Math.atan2(z, Math.hypot(x, y)))}, azimuth ${degrees(Math.atan2(y, x))}`;
  if (spectrum.length === 0) return `${where}\nNo light of sun or moon.`;
  const middle = rows(spectrum).reduce((a, b) => (Math.abs(b.wavelength - 550) < Math.abs(a.wavelength - 550) ? b : a));
  return [
    where,
    `At ${middle.wavelength} nm: ${middle.radiance.toPrecision(4)} W m⁻² sr⁻¹ nm⁻¹`,
    `Degree of polarisation ${(100 * middle.degree).toFixed(1)} %, angle from the vertical ${middle.angle.toFixed(0)}°`,
  ].join("\n");
}

const SVG = "http://www.w3.org/2000/svg";

function shape(name: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, `${value}`);
  made.textContent = text;
  return made;
}

/** Radiance as a line, the degree of polarisation (0 to 1) as a dashed one. */
export function chart(svg: SVGSVGElement, spectrum: Spectrum): void {
  const all = rows(spectrum);
  const most = Math.max(...all.map((row) => row.radiance), 1e-30);
  const x = (wavelength: number) =>
    MARGIN + ((wavelength - LOWEST) / (HIGHEST - LOWEST)) * (WIDTH - 2 * MARGIN);
  const y = (share: number) => HEIGHT - MARGIN - share * (HEIGHT - 2 * MARGIN);
  const line = (share: (row: Row) => number) =>
    all.map((row) => `${x(row.wavelength).toFixed(1)},${y(share(row)).toFixed(1)}`).join(" ");
  const ticks = [300, 500, 700, 900, 1100].map((wavelength) =>
    shape("text", { x: x(wavelength), y: HEIGHT - 4, fill: "#b9bec7", "font-size": 10, "text-anchor": "middle" }, `${wavelength}`),
  );
  const plot = { fill: "none", "stroke-width": 1.5 };
  svg.replaceChildren(
    shape("title", {}, `Spectral radiance, at most ${most.toPrecision(3)} W m⁻² sr⁻¹ nm⁻¹; dashed: degree of polarisation`),
    shape("path", { d: `M${MARGIN},${y(0)}H${WIDTH - MARGIN}`, stroke: "#5b6471" }),
    ...ticks,
    shape("polyline", { ...plot, points: line((row) => row.radiance / most), stroke: "#6cb2ff" }),
    shape("polyline", { ...plot, points: line((row) => row.degree), stroke: "#ffb454", "stroke-dasharray": "4 3" }),
    shape("text", { x: MARGIN, y: 11, fill: "#6cb2ff", "font-size": 10 }, `${most.toPrecision(3)} W m⁻² sr⁻¹ nm⁻¹`),
    shape("text", { x: WIDTH - MARGIN, y: 11, fill: "#ffb454", "font-size": 10, "text-anchor": "end" }, "polarised, 0 to 1"),
  );
}
