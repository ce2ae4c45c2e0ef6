// Questions to the viewer, if a viewer serves the page: `paracosm-fuzz view`.

import type { Grid, Real, Run } from "./data";

/** A test that the viewer has run. */
export interface Ran {
  test: Record<string, unknown>;
  verdict: string;
  robustness: Record<string, Real>;
  trace_hash: string | null;
  /** The reason why the test has no result. */
  problem: string | null;
  /** What differs from the log, if a test of the campaign ends otherwise now. */
  differs: string | null;
  /** The run; null if there is no world to show. */
  run: Run | null;
}

/** A test: its index in the campaign, or for a new test a number for each coordinate: the value, or the position of the level. */
export type Wanted = number | number[];

/** The simplest test near a failing test that still fails. */
export interface Simplest {
  sentence: string;
  search: string;
  numbers: number[];
  same_mode: boolean;
  /** The failures of both tests in words. */
  failures: [string, string];
  parameters: { name: string; unit: string | null; before: unknown; after: unknown; nominal: boolean }[];
}

/** A failure with the runs of the reference drivers. */
export interface Blamed {
  sentence: string;
  violates: string[];
  runs: Record<string, { verdict: string; prevents: boolean | null; robustness: Record<string, Real>; error?: string }>;
}

async function reply(question: unknown, signal?: AbortSignal): Promise<Response> {
  let reply: Response;
  try {
    reply = await fetch("ask", { method: "POST", body: JSON.stringify(question), signal });
  } catch {
    throw new Error(signal?.aborted ? "nobody waits for the answer any more" : "the viewer does not answer: start `view` again");
  }
  if (!reply.ok) throw new Error((await reply.text()) || `the viewer refuses (${reply.status})`);
  return reply;
}

const ask = async <T>(question: unknown, signal?: AbortSignal) => (await (await reply(question, signal)).json()) as T;

/** Runs a test. */
export const ran = (test: Wanted) => ask<Ran>({ run: test });

/** The number of tests of the campaign by now, and whether more may come. */
export const progress = () => ask<{ tests: number; unfinished: boolean }>("progress");

/** The estimate over two coordinates, by their positions; null if there is none. */
export const mapped = (axes: [number, number]) => ask<Grid | null>({ map: axes });

export const shrunk = (test: Wanted, signal: AbortSignal) => ask<Simplest>({ shrink: test }, signal);

export const blamed = (test: Wanted, signal: AbortSignal) => ask<Blamed>({ blame: test }, signal);

/** The names of the cameras that film tests. */
export const cameras = () => ask<string[]>("cameras");

/** The film of a test by a camera. */
export const filmed = async (test: Wanted, camera: string, signal: AbortSignal) => (await reply({ film: { test, camera } }, signal)).blob();

/** The page as it is now. */
export async function pageByNow(): Promise<globalThis.Document> {
  const reply = await fetch("");
  if (!reply.ok) throw new Error(await reply.text());
  return new DOMParser().parseFromString(await reply.text(), "text/html");
}
