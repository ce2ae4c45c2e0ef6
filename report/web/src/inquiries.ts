// Questions about a failing test that take many runs: the simplest test that still fails, and the drivers that prevent the failure.

import { h } from "./dom";
import { sign } from "./marks";
import { blamed, shrunk, type Wanted } from "./server";
import type { Store } from "./store";
import { digits, reason, withUnit } from "./words";

export class Inquiries {
  readonly element = h("div", { class: "inquiries" });
  private leaving = new AbortController();

  constructor(private readonly store: () => Store) {}

  /** Offers the questions about a test, if it fails. */
  about(test: Wanted, verdict: string) {
    this.clear();
    const { page } = this.store();
    if (!page.served || verdict !== "fail") return;
    const answer = h("div", { class: "answer", "aria-live": "polite" });
    const button = (name: string, title: string, answered: (signal: AbortSignal) => Promise<Node[]>) =>
      h("button", { type: "button", class: "quiet", title, click: () => void this.ask(answer, name, answered) }, name);
    this.element.replaceChildren(
      button("Shrink", "Find the simplest test near this test that still fails", (signal) => this.simplest(test, signal)),
      // A system has no driver that others could replace.
      page.study.scenario === null ? "" : button("Blame", "Run this test with the reference drivers: do they prevent the failure?", (signal) => this.drivers(test, signal)),
      answer,
    );
  }

  /** Ends the question that is being answered, and shows nothing. */
  clear() {
    this.leaving.abort();
    this.leaving = new AbortController();
    this.element.replaceChildren();
  }

  private async ask(place: HTMLElement, name: string, answered: (signal: AbortSignal) => Promise<Node[]>) {
    this.leaving.abort();
    const { signal } = (this.leaving = new AbortController());
    place.replaceChildren(h("p", { class: "note" }, `${name}: the tests run.`));
    let parts: Node[];
    try {
      parts = await answered(signal);
    } catch (error) {
      parts = [h("p", { class: "note" }, `${name}: ${reason(error)}`)];
    }
    if (signal.aborted) return;
    place.replaceChildren(...parts);
    place.scrollIntoView({ block: "nearest" });
  }

  private async simplest(test: Wanted, signal: AbortSignal): Promise<Node[]> {
    const { sentence, search, numbers, parameters, same_mode, failures } = await shrunk(test, signal);
    const cell = (value: unknown, unit: string | null) => `${inWords(value)}${unit ? ` ${unit}` : ""}`;
    const rows = parameters.map(({ name, unit, before, after, nominal }) => [name, cell(before, unit), cell(after, unit), nominal ? "nominal" : ""]);
    return [
      h("p", {}, h("strong", {}, `${typeof test === "number" ? `Test ${test}` : "This test"} ${sentence}.`)),
      table(["parameter", "before", "simplest", ""], rows),
      ...(same_mode ? [] : [h("p", {}, `The simplest test fails in another way: ${failures[1]}. Before: ${failures[0]}.`)]),
      h("p", { class: "muted" }, `The simplest test was ${search}. `, h("button", { type: "button", class: "quiet", click: () => this.store().attempt(numbers) }, "Play the simplest test")),
    ];
  }

  private async drivers(test: Wanted, signal: AbortSignal): Promise<Node[]> {
    const { sentence, violates, runs } = await blamed(test, signal);
    const units = new Map(this.store().page.requirements.map(({ id, unit }) => [id, unit]));
    const rows = Object.entries(runs).map(([name, { verdict, prevents, robustness, error }]) => [
      name, `${sign(verdict)} ${verdict}`, prevents === null ? "unknown" : prevents ? "yes" : "no",
      ...violates.map((id) => error ?? (robustness[id] === null ? "undecided" : withUnit(robustness[id], units.get(id) ?? null))),
    ]);
    return [h("p", {}, h("strong", {}, `${sentence[0].toUpperCase()}${sentence.slice(1)}.`)), table(["driver", "verdict", "prevents it", ...violates.map((id) => `robustness of ${id}`)], rows)];
  }
}

/** A value of a parameter in words: numbers have five digits. */
function inWords(value: unknown): string {
  if (Array.isArray(value)) return value.map(inWords).join(", ");
  return typeof value === "number" ? digits(value) : String(value);
}

const table = (head: string[], rows: string[][]) =>
  h("div", { class: "wide" }, h("table", { class: "plain" }, h("thead", {}, h("tr", {}, ...head.map((title) => h("th", {}, title)))), h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map((cell) => h("td", {}, cell)))))));
