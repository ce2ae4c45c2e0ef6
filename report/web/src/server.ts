// Questions to the viewer, if a viewer serves the page: `paracosm-fuzz view`.

import type { Real, Run } from "./data";

/** A test that the viewer has run. */
export interface Ran {
  test: Record<string, unknown>;
  verdict: string;
  robustness: Record<string, Real>;
  trace_hash: string | null;
  /** The reason why the test has no result. */
  problem: string | null;
  /** The run; null if there is no world to show. */
  run: Run | null;
}

async function ask<T>(path: string, body?: unknown): Promise<T> {
  const how = body === undefined ? {} : { method: "POST", body: JSON.stringify(body) };
  let reply: Response;
  try {
    reply = await fetch(path, how);
  } catch {
    throw new Error("the viewer does not answer: start `view` again");
  }
  if (!reply.ok) throw new Error((await reply.text()) || `the viewer refuses (${reply.status})`);
  return (await reply.json()) as T;
}

/** Runs the test of the campaign with an index again. */
export const ranAgain = (index: number) => ask<Ran>(`run/${index}`);

/** Runs a new test, with a number for each coordinate: the value, or the position of the level. */
export const ranAt = (numbers: number[]) => ask<Ran>("try", numbers);

/** The number of tests of the campaign by now, and whether more may come. */
export const progress = () => ask<{ tests: number; unfinished: boolean }>("progress");

/** The page as it is now. */
export async function pageByNow(): Promise<globalThis.Document> {
  const reply = await fetch("");
  if (!reply.ok) throw new Error(await reply.text());
  return new DOMParser().parseFromString(await reply.text(), "text/html");
}
