/** Numbers, lengths, bytes and times in words of the reader's language, always with a unit. */
import { language, t } from "./text";

const UNITS: Record<string, string> = {
  micron: "µm",
  millimeter: "mm",
  centimeter: "cm",
  meter: "m",
  inch: "in",
  foot: "ft",
};

/** As many as browsers write. */
const MOST_DECIMALS = 20;

export function number(value: number, digits = 3): string {
  return new Intl.NumberFormat(language(), { maximumSignificantDigits: digits }).format(value);
}

export function count(value: number): string {
  return new Intl.NumberFormat(language()).format(value);
}

/** The name of a unit of length; files that state none are in "units". */
export function unitName(unit: string | null | undefined): string {
  return UNITS[unit ?? ""] ?? t("unit_unknown");
}

export function length(value: number | null | undefined, unit: string | null | undefined): string {
  return value === null || value === undefined ? "–" : `${number(value)} ${unitName(unit)}`;
}

/** A place, to a ten-thousandth of the diagonal of the scan: scans with coordinates of a map lie far from zero. */
export function coordinates(point: readonly number[] | null, diagonal: number | null): string {
  if (point === null) return "–";
  if (!diagonal) return point.map((value) => number(value, 4)).join(" / ");
  const decimals = Math.min(Math.max(Math.ceil(-Math.log10(diagonal / 10_000)), 0), MOST_DECIMALS);
  const format = new Intl.NumberFormat(language(), { maximumFractionDigits: decimals });
  return point.map((value) => format.format(value)).join(" / ");
}

/** Length of the diagonal of a box. */
export function diagonalOf({ min, max }: { min: readonly number[]; max: readonly number[] }): number {
  return Math.hypot(...max.map((value, axis) => value - min[axis]!));
}

export function percent(share: number | null | undefined): string {
  if (share === null || share === undefined) return "–";
  return new Intl.NumberFormat(language(), { style: "percent", maximumFractionDigits: 0 }).format(share);
}

/** A limit that was typed as a share: as it was meant, also where it is below a percent. */
export function limitPercent(share: number): string {
  return new Intl.NumberFormat(language(), { style: "percent", maximumSignificantDigits: 3 }).format(share);
}

export function bytes(value: number): string {
  const names = ["B", "KiB", "MiB", "GiB", "TiB"];
  let step = 0;
  for (; value >= 1024 && step < names.length - 1; step += 1) value /= 1024;
  return `${number(value)} ${names[step]}`;
}

export function duration(seconds: number): string {
  if (seconds < 60) return `${number(seconds, 2)} s`;
  if (seconds < 3600) return `${Math.round(seconds / 60)} min`;
  return `${number(seconds / 3600, 2)} h`;
}

export function time(text: string | null | undefined): string {
  if (!text) return "–";
  return new Intl.DateTimeFormat(language(), { dateStyle: "medium", timeStyle: "short" }).format(new Date(text));
}
