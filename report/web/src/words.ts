// Numbers and counts in words, as the program prints them.

import type { Real } from "./data";

/** A number with five significant digits and without zeros at its end. */
export function digits(real: Real | undefined): string {
  if (real === null || real === undefined || Number.isNaN(real)) return "unknown";
  const number = real === "inf" ? Infinity : real === "-inf" ? -Infinity : real;
  if (!Number.isFinite(number)) return number > 0 ? "infinite" : "-infinite";
  return String(Number(number.toPrecision(5)));
}

export function plural(count: number, word: string): string {
  return count === 1 ? `1 ${word}` : `${count.toLocaleString("en")} ${word}s`;
}

export function percent(share: number): string {
  return `${(100 * share).toFixed(share > 0 && share < 0.01 ? 2 : 1)} %`;
}

export function withUnit(number: Real | undefined, unit: string | null): string {
  return unit ? `${digits(number)} ${unit}` : digits(number);
}

/** The reason of an error in words. */
export const reason = (error: unknown) => (error instanceof Error ? error.message : String(error));

/** A value that somebody has pointed at, with no more digits than a thousandth of the width in sight, and within the range of its coordinate. */
export function pointed(value: number, width: number, [lo, hi]: [number, number]): number {
  const step = 10 ** Math.floor(Math.log10(Math.max(width, Number.MIN_VALUE) / 1000));
  const rounded = Number((Math.round(value / step) * step).toPrecision(12));
  return Math.min(hi, Math.max(lo, Number.isFinite(rounded) ? rounded : value));
}
