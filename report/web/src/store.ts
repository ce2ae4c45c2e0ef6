// The state that all parts of the page share: which tests pass the filters, and which test is shown.

import type { Document, Seen, Tests } from "./data";

export class Store {
  /** 1 for each row that passes all filters. */
  readonly mask: Uint8Array;
  kept: number;
  /** For each coordinate the range that passes, as numbers or levels. */
  readonly ranges = new Map<number, [number, number]>();
  verdict: number | null = null;
  mode: number | null = null;
  /** New tests that were run from the page, which are no tests of the campaign. */
  readonly tried: { numbers: number[]; verdict: string }[] = [];
  private readonly listeners: (() => void)[] = [];

  constructor(
    readonly page: Document,
    readonly tests: Tests,
    readonly show: (index: number) => void,
    readonly run: (index: number) => Promise<Seen>,
    /** Runs a new test with a number for each coordinate, and plays it. */
    readonly attempt: (numbers: number[]) => void,
  ) {
    this.mask = new Uint8Array(tests.rows).fill(1);
    this.kept = tests.rows;
  }

  onFilter(listener: () => void) {
    this.listeners.push(listener);
  }

  /** Applies the filters, and tells all parts. */
  filter() {
    const { tests, mask } = this;
    mask.fill(1);
    if (this.verdict !== null) for (let i = 0; i < tests.rows; i++) if (tests.verdict[i] !== this.verdict) mask[i] = 0;
    if (this.mode !== null) for (let i = 0; i < tests.rows; i++) if (tests.mode[i] !== this.mode) mask[i] = 0;
    for (const [at, range] of this.ranges) {
      // The values are 32-bit numbers, so that the ends have to be, too.
      const [lo, hi] = range.map(Math.fround);
      const values = tests.coordinates[at];
      for (let i = 0; i < tests.rows; i++) if (!(values[i] >= lo && values[i] <= hi)) mask[i] = 0;
    }
    let kept = 0;
    for (let i = 0; i < tests.rows; i++) kept += mask[i];
    this.kept = kept;
    this.listeners.forEach((listener) => listener());
  }

  /** Tells all parts of a new test. */
  add(numbers: number[], verdict: string) {
    this.tried.push({ numbers, verdict });
    this.listeners.forEach((listener) => listener());
  }

  /** The numbers of a test: the value of each continuous coordinate, and the position of each level. */
  numbersOf(row: number): number[] {
    return this.page.coordinates.map(({ range }, at) => {
      const value = this.tests.coordinates[at][row];
      // The table has 32-bit numbers, which may lie just outside of the range.
      return range ? Math.min(range[1], Math.max(range[0], Number(value.toPrecision(7)))) : value;
    });
  }

  /** The numbers of a test in the middle of the space. */
  middle(): number[] {
    return this.page.coordinates.map(({ range }) => (range ? (range[0] + range[1]) / 2 : 0));
  }

  clear() {
    this.ranges.clear();
    this.verdict = this.mode = null;
    this.filter();
  }

  get isFiltered(): boolean {
    return this.ranges.size > 0 || this.verdict !== null || this.mode !== null;
  }

  verdictName(row: number): string {
    return this.page.verdicts[this.tests.verdict[row]].name;
  }

  rowOf(index: number): number {
    // The rows are in the order of their indices.
    const { index: all } = this.tests;
    let [low, high] = [0, all.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (all[middle] < index) low = middle + 1;
      else high = middle;
    }
    return all[low] === index ? low : -1;
  }

  /** The values of a test in words. */
  valuesOf(row: number): [string, string][] {
    return this.page.coordinates.map((coordinate, at) => [coordinate.name, this.valueOf(at, row)]);
  }

  valueOf(at: number, row: number): string {
    const { levels, unit } = this.page.coordinates[at];
    const value = this.tests.coordinates[at][row];
    const words = levels ? (levels[value] ?? "unknown") : String(Number(value.toPrecision(5)));
    return unit ? `${words} ${unit}` : words;
  }
}
