// Numbers and counts in words, as the program prints them.

/** A number with five significant digits and without zeros at its end. */
export function digits(number: number | null | undefined): string {
  if (number === null || number === undefined || Number.isNaN(number)) return "unknown";
  if (!Number.isFinite(number)) return number > 0 ? "infinite" : "-infinite";
  return String(Number(number.toPrecision(5)));
}

export function plural(count: number, word: string): string {
  return count === 1 ? `1 ${word}` : `${count.toLocaleString("en")} ${word}s`;
}

export function percent(share: number): string {
  return `${(100 * share).toFixed(share > 0 && share < 0.01 ? 2 : 1)} %`;
}

export function withUnit(number: number | null | undefined, unit: string | null): string {
  return unit ? `${digits(number)} ${unit}` : digits(number);
}
