// The data of the page: a document, a table of tests, and runs that are read when they are played. docs/report-data.md describes them.

import { ran } from "./server";

export interface Coordinate {
  name: string;
  label: string;
  unit: string | null;
  range: [number, number] | null;
  levels: string[] | null;
}

export interface Grid {
  axes: [number, number];
  size: [number, number];
  percent: string;
  decided: string;
}

/** A number as JSON has it, which has no infinities. */
export type Real = number | "inf" | "-inf" | null;

export interface Worst {
  index: number;
  requirement: string;
  robustness: Real;
  verdict: string;
}

export interface Mode {
  name: string;
  words: string;
  count: number;
  representative: number;
  worst: number;
  violates: string[];
}

export interface Requirement {
  id: string;
  text: string;
  formula: string | null;
  unit: string;
  severity: string | null;
  source: string | null;
  violated: number;
  undecided: number;
  worst: [number, Real] | null;
}

export interface Growth {
  tests: number;
  dispersion: [number, number] | null;
  k_wise: number | null;
}

export interface Column {
  of: "index" | "verdict" | "mode" | "impact" | "coordinate" | "robustness";
  name?: string;
  kind: "u8" | "u16" | "u32" | "f32";
}

export interface Changed {
  index: [number, number];
  verdicts: [string, string];
}

/** Points of Euro NCAP. */
export interface Points {
  grid: string;
  points: number | null;
  of: number;
}

export interface Changes {
  titles: [string, string];
  tests: number;
  otherwise: string[];
  unpaired: [number, number];
  points?: [Points, Points];
  failing: [number, number];
  still_failing: number;
  new_failures: Changed[];
  mended: Changed[];
  mcnemar_p: number;
}

export interface Document {
  format: string;
  software: string;
  /** True if a viewer serves the page, and answers its questions. */
  served: boolean;
  study: {
    title: string;
    scenario: string | null;
    strategy: string;
    seed: number | null;
    budget: number;
    unfinished: boolean;
    hash: string;
    folder: string;
    program: string;
    trusting: string;
    fixed: Record<string, unknown>;
  };
  verdicts: { name: string; tests: number }[];
  requirements: Requirement[];
  coordinates: Coordinate[];
  axes: [number, number] | null;
  maps: Grid[];
  hole: Record<string, [number, number]> | null;
  without_effect: { name: string; why: string }[];
  worst: Worst | null;
  worst_plausible: Worst | null;
  plausible: Record<string, [number, number]> | null;
  modes: { failures: number; modes: Mode[] };
  growth: Growth[];
  findings: { label: string; lines: string[]; table: { head: string[]; rows: string[][] } | null }[];
  results: Record<string, unknown>;
  changes: Changes | null;
  tests: { all: number; rows: number; columns: Column[] };
  runs: { roads: Record<string, number>; left_out: number; why: string | null };
}

export interface Ground {
  surface: string;
  polygons: number[][];
}

export interface Played {
  name: string;
  class: string;
  length: number;
  width: number;
  round: boolean;
  height: number;
  poses: number[];
  there: [number, number];
}

export interface Curve {
  name: string;
  /** The unit of the values; empty if they have none. */
  unit: string;
  values: (number | null)[];
}

export interface Margin {
  id: string;
  unit: string;
  lower: (number | null)[];
  upper: (number | null)[];
  end: Real;
}

export interface Run {
  index: number;
  verdict: string;
  times: number[];
  bodies: Played[];
  touched: number | null;
  roads: Ground[];
  signals: Curve[];
  robustness: Margin[];
}

export type Numbers = Uint8Array | Uint16Array | Uint32Array | Float32Array;

/** The tests of the page, a row for each. */
export interface Tests {
  rows: number;
  index: Uint32Array;
  verdict: Uint8Array;
  mode: Uint16Array;
  impact: Float32Array;
  coordinates: Numbers[];
  robustness: { id: string; values: Float32Array }[];
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** The bytes of a text in base64 that are not compressed. */
export const plain = bytesOf;

async function unpacked(id: string): Promise<ArrayBuffer> {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  const stream = new Blob([bytesOf(element.textContent ?? "")]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** Marks that turn the direction of a text. In a name of a stranger, they would also turn the words and numbers beside the name. */
const TURNS = /[\u200e\u200f\u202a-\u202e\u2066-\u2069]/g;

const readable = (_: string, value: unknown) => (typeof value === "string" ? value.replace(TURNS, "\ufffd") : value);

async function json<T>(id: string): Promise<T> {
  return JSON.parse(new TextDecoder().decode(await unpacked(id)), readable) as T;
}

export const readDocument = () => json<Document>("document");

export async function readTests(described: Document["tests"]): Promise<Tests> {
  const bytes = await unpacked("tests");
  const { rows } = described;
  const tests: Partial<Tests> & Pick<Tests, "coordinates" | "robustness"> = { rows, coordinates: [], robustness: [] };
  let at = 0;
  for (const column of described.columns) {
    const size = { u8: 1, u16: 2, u32: 4, f32: 4 }[column.kind];
    // A copy, because a typed array begins at a multiple of its size.
    const part = bytes.slice(at, at + rows * size);
    at += rows * size;
    const numbers = {
      u8: () => new Uint8Array(part),
      u16: () => new Uint16Array(part),
      u32: () => new Uint32Array(part),
      f32: () => new Float32Array(part),
    }[column.kind]();
    if (column.of === "coordinate") tests.coordinates.push(numbers);
    else if (column.of === "robustness") tests.robustness.push({ id: column.name ?? "", values: numbers as Float32Array });
    else Object.assign(tests, { [column.of]: numbers });
  }
  return tests as Tests;
}

const roads = new Map<number, Promise<Ground[]>>();

/** The run of a test of the campaign. */
export interface Seen {
  /** The run; null if the page does not have it. */
  run: Run | null;
  /** A sentence if the test ends otherwise now than in the log. */
  differs: string | null;
}

/** Reads the run of a test. */
export async function readRun(page: Document, index: number): Promise<Seen> {
  if (page.served && page.study.scenario !== null) return ran(index);
  return { run: await inPage(page, index), differs: null };
}

async function inPage(page: Document, index: number): Promise<Run | null> {
  const place = page.runs.roads[index];
  if (place === undefined) return null;
  if (!roads.has(place)) roads.set(place, json<Ground[]>(`roads-${place}`));
  const run = await json<Run>(`run-${index}`);
  run.roads = await roads.get(place)!;
  return run;
}
