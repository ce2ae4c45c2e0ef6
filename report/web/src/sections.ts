// The parts of the page that are words and small pictures: the verdict, the failure modes, the findings.

import uPlot from "uplot";
import type { Document, Worst } from "./data";
import { colour, h, onTheme } from "./dom";
import { modeColour, mark, sign } from "./marks";
import { Motion, Player } from "./player";
import type { Store } from "./store";
import { digits, percent, plural, withUnit } from "./words";

/** The result of the campaign in a sentence, with all numbers that it needs. */
export function verdict(page: Document): HTMLElement {
  const count = (name: string) => page.verdicts.find((verdict) => verdict.name === name)?.tests ?? 0;
  const all = page.tests.all;
  const [fail, pass] = [count("fail"), count("pass")];
  const others = ["unpreventable", "inconclusive", "invalid", "error"].filter((name) => count(name) > 0).map((name) => `${count(name).toLocaleString("en")} ${name}`);
  const share = all > 0 ? ` (${percent(fail / all)})` : "";
  const judged = fail + pass + count("unpreventable");
  // That no test fails says little if tests have no result.
  const word = fail > 0 ? "fail" : pass === 0 || count("error") > 0 ? "inconclusive" : "pass";
  const sentence = all === 0 ? "No test has run." : fail > 0
    ? `${fail.toLocaleString("en")} of ${plural(all, "test")} fail${share}, ${pass.toLocaleString("en")} pass`
    : judged === 0 ? `None of ${plural(all, "test")} shows whether it passes` : `No failure in ${plural(all, "test")}: ${pass.toLocaleString("en")} pass`;
  return h("p", { class: `headline verdict ${word}` }, `${sign(word)} ${sentence}${others.length > 0 ? `, ${others.join(", ")}` : ""}.`);
}

/** A picture of a test at its end, which plays the test. */
export function thumbnail(store: Store, index: number, label: string): HTMLElement {
  // A system has no world to draw.
  if (store.page.study.scenario === null) return h("button", { type: "button", class: "quiet", click: () => store.show(index) }, `Show ${label}`);
  const button = h("button", { type: "button", class: "thumb", "aria-label": `Play ${label}`, click: () => store.show(index) });
  const place = h("span", { class: "picture" });
  button.append(place, h("span", { class: "playmark" }, `▶ ${label}`));
  void store.run(index).then(({ run }) => {
    if (!run) {
      place.append(h("span", { class: "muted" }, "no run on this page"));
      return;
    }
    const motion = new Motion(run);
    const player = new Player(motion, `${label} at its end, from above`);
    player.time = motion.duration;
    place.append(player.sheet.canvas);
  });
  return button;
}

/** The test that the first screen shows, with what it is: the worst plausible failure, or else the worst test. */
function worstTest(store: Store): [Worst, string] | null {
  const { worst, worst_plausible: plausible, plausible: ranges, modes } = store.page;
  if (plausible?.verdict === "fail") return [plausible, ranges ? "Worst plausible failure" : "Worst failure"];
  if (!worst) return null;
  // The worst test may be unpreventable, which is no failure. The first mode has the most failures.
  if (worst.verdict !== "fail" && modes.modes.length > 0) {
    const index = modes.modes[0].worst;
    const row = store.rowOf(index);
    const margins = row < 0 ? [] : store.tests.robustness.filter(({ values }) => values[row] < 0);
    if (margins.length > 0) return [{ index, verdict: "fail", requirement: margins[0].id, robustness: margins[0].values[row] }, "Worst failure of the largest mode"];
  }
  return [worst, worst.verdict === "fail" ? (ranges ? "Worst failure, not plausible" : "Worst failure") : "Nearest to a failure"];
}

export function worstCard(store: Store): HTMLElement | null {
  const { page } = store;
  const found = worstTest(store);
  if (!found) return null;
  const [worst, title] = found;
  const row = store.rowOf(worst.index);
  const unit = page.requirements.find(({ id }) => id === worst.requirement)?.unit ?? null;
  const mode = row < 0 ? 0 : store.tests.mode[row];
  return h("section", { class: "card worst" },
    h("h2", {}, title),
    thumbnail(store, worst.index, `test ${worst.index}`),
    h("p", {}, `${worst.requirement}: robustness ${withUnit(worst.robustness, unit)}`),
    mode ? h("p", {}, page.modes.modes[mode - 1].words) : null,
    row < 0 ? null : h("p", { class: "muted" }, store.valuesOf(row).map(([name, value]) => `${name} ${value}`).join(", ")),
  );
}

export function modes(store: Store): HTMLElement | null {
  const { page } = store;
  const { modes: all, failures } = page.modes;
  if (all.length === 0) return null;
  const cards = all.map((mode, number) => {
    const legend = h("canvas", { width: 28, height: 28, class: "legend", "aria-hidden": "true" });
    const paint = () => {
      const context = legend.getContext("2d")!;
      context.clearRect(0, 0, 28, 28);
      mark(context, number + 1, 14, 14, 9, modeColour(number + 1));
    };
    paint();
    onTheme(paint);
    const filter = h("button", { type: "button", class: "quiet", "aria-pressed": "false", click: () => {
      store.mode = store.mode === number + 1 ? null : number + 1;
      store.filter();
    } }, "Only these");
    store.onFilter(() => filter.setAttribute("aria-pressed", String(store.mode === number + 1)));
    return h("article", { class: "card" },
      h("h3", {}, legend, ` ${plural(mode.count, "test")} (${percent(mode.count / failures)})`),
      thumbnail(store, mode.representative, `test ${mode.representative}`),
      h("p", {}, mode.words),
      h("p", { class: "controls" }, filter, h("button", { type: "button", class: "quiet", click: () => store.show(mode.worst) }, `Worst: test ${mode.worst}`)),
    );
  });
  return section("modes", `Failure modes of ${plural(failures, "failing test")}`, h("div", { class: "cards" }, ...cards));
}

export function section(id: string, title: string, ...children: (Node | null)[]): HTMLElement {
  return h("section", { id }, h("h2", {}, title), ...children);
}

export function findings(page: Document): HTMLElement | null {
  if (page.findings.length === 0) return null;
  return section("findings", "Findings", h("dl", { class: "findings" }, ...page.findings.flatMap(({ label, lines, table }) => [
    h("dt", {}, label), ...lines.map((line) => h("dd", {}, line)),
    table ? h("dd", {}, h("table", { class: "plain" },
      h("thead", {}, h("tr", {}, ...table.head.map((title) => h("th", { scope: "col" }, title)))),
      h("tbody", {}, ...table.rows.map(([first, ...cells]) => h("tr", {}, h("th", { scope: "row" }, first), ...cells.map((cell) => h("td", {}, cell))))))) : null,
  ])));
}

export function requirements(store: Store): HTMLElement {
  const rows = store.page.requirements.map((requirement) => {
    const { id, text, formula, unit, severity, source, violated, undecided, worst } = requirement;
    const more = [severity, source].filter(Boolean).join(", ");
    return h("tr", {},
      h("th", { scope: "row" }, id, more ? h("div", { class: "muted" }, more) : null),
      h("td", {}, text, formula && formula !== text ? h("div", {}, h("code", {}, formula)) : null),
      h("td", { class: `number verdict ${violated > 0 ? "fail" : ""}` }, violated.toLocaleString("en")),
      h("td", { class: "number" }, undecided.toLocaleString("en")),
      h("td", {}, worst ? h("button", { type: "button", class: "quiet", click: () => store.show(worst[0]) }, `${withUnit(worst[1], unit)} in test ${worst[0]}`) : ""),
    );
  });
  const head = ["requirement", "meaning", "violated", "undecided", "least robustness"].map((name) => h("th", { scope: "col" }, name));
  return section("requirements", "Requirements", h("div", { class: "wide" }, h("table", { class: "plain" }, h("thead", {}, h("tr", {}, ...head)), h("tbody", {}, ...rows))));
}

/** The number of changed tests that are shown at once. */
const FIRST = 12;

/** What changed since the campaign before, in a line of the first screen that leads to the details. */
export function changed(page: Document): HTMLElement | null {
  const { changes } = page;
  if (!changes) return null;
  const { new_failures: added, mended, still_failing: still, titles } = changes;
  return h("p", { class: "changed" }, `Since ${titles[0]}: ${plural(added.length, "new failure")}, ${mended.length} mended, ${still} still failing. `, h("a", { href: "#changes" }, "What changed"));
}

/** Says why there is no failure map; null if there is one. */
export function withoutMap(page: Document): string | null {
  if (page.axes !== null) return null;
  const continuous = page.coordinates.filter(({ range }) => range).length;
  if (continuous < 2) return `There is no failure map: a map needs two open continuous parameters, and this study has ${continuous === 0 ? "none" : "one"}.`;
  return "There is no failure map: no test has a result.";
}

export function changes(store: Store): HTMLElement | null {
  const { changes } = store.page;
  if (!changes) return null;
  const { titles, tests, otherwise, unpaired, points, failing, still_failing: still, new_failures: added, mended, mcnemar_p: p } = changes;
  const alone = [0, 1].filter((at) => unpaired[at] > 0).map((at) => `${plural(unpaired[at], "test")} of ${titles[at]} (${at === 0 ? "before" : "after"})`);
  const buttons = (all: typeof added) => all.map(({ index }) => h("button", { type: "button", class: "quiet", click: () => store.show(index[1]) }, `test ${index[1]}`));
  const list = (label: string, all: typeof added) => [h("dt", {}, `${label}: ${all.length}`), h("dd", {}, ...buttons(all.slice(0, FIRST)),
    all.length > FIRST ? h("details", {}, h("summary", {}, `${plural(all.length - FIRST, "more test")}`), ...buttons(all.slice(FIRST))) : null)];
  return section("changes", "What changed",
    h("p", {}, `Before (${titles[0]}): ${failing[0]} of ${plural(tests, "test")} fail. After (${titles[1]}): ${failing[1]} fail, ${still} of them in both. McNemar's test: p = ${digits(p)}.`),
    otherwise.length > 0 ? h("p", {}, `Also different: ${otherwise.join("; ")}.`) : null,
    alone.length > 0 ? h("p", {}, `Without a pair, and not compared: ${alone.join(" and ")}.`) : null,
    points ? h("p", {}, `Points on the grid ${points[0].grid}: ${digits(points[0].points)} before, ${digits(points[1].points)} after, of ${digits(points[0].of)}.`) : null,
    h("dl", { class: "findings" }, ...list("new failures", added), ...list("mended", mended)));
}

/** The least value so far: an empty box of more tests is no larger, so an earlier bound holds for later sizes, too. */
function leastSoFar(values: (number | null)[]): (number | null)[] {
  let least = Infinity;
  return values.map((value) => (value === null ? null : (least = Math.min(least, value))));
}

export function growth(page: Document): HTMLElement | null {
  const { growth: sizes } = page;
  if (sizes.length < 3) return null;
  const place = h("div", { class: "growth" });
  const curves = [
    { label: "largest empty box, at most", values: leastSoFar(sizes.map(({ dispersion }) => dispersion && dispersion[1])), stroke: () => colour("pass") },
    { label: "combinations of values covered", values: sizes.map(({ k_wise: share }) => share), stroke: () => "#009e73", dash: [5, 4] },
  ].filter(({ values }) => values.some((value) => value !== null));
  if (curves.length === 0) return null;
  const plot = new uPlot({
    width: 600, height: 220,
    scales: { x: { time: false, distr: 3 }, y: { range: [0, 1] } },
    axes: [
      { stroke: () => colour("muted"), grid: { stroke: () => colour("grid"), width: 1 }, label: "tests", labelSize: 18, font: "11px system-ui", labelFont: "12px system-ui" },
      { stroke: () => colour("muted"), grid: { stroke: () => colour("grid"), width: 1 }, size: 46, font: "11px system-ui" },
    ],
    series: [{ label: "tests" }, ...curves.map(({ label, stroke, dash }) => ({ label, stroke, dash, width: 2, value: (_: uPlot, value: number | null) => (value === null ? "" : digits(value)) }))],
  }, [sizes.map(({ tests }) => tests), ...curves.map(({ values }) => values)] as uPlot.AlignedData, place);
  new ResizeObserver(() => place.clientWidth > 0 && plot.setSize({ width: place.clientWidth, height: 220 })).observe(place);
  onTheme(() => plot.redraw());
  return section("coverage", "Coverage over the number of tests", place);
}

export function results(page: Document): HTMLElement | null {
  const files = Object.entries(page.results);
  if (files.length === 0) return null;
  return section("results", "Results as data", ...files.map(([file, value]) => h("details", {}, h("summary", {}, file), h("pre", {}, JSON.stringify(value, null, 2)))));
}

export function about(page: Document): HTMLElement {
  const { study, runs, software } = page;
  const fixed = Object.entries(study.fixed).map(([name, value]) => `${name} ${JSON.stringify(value)}`).join(", ");
  const there = Object.keys(runs.roads).length;
  const left = runs.left_out > 0 ? ` ${plural(runs.left_out, "run")} that the page would show ${runs.left_out === 1 ? "is" : "are"} left out${runs.why ? `: ${runs.why}` : ", because they do not fit into the size that was asked for"}.` : "";
  const rows: [string, string][] = [
    ["study", study.title],
    ["strategy", `${study.strategy}${study.seed === null ? "" : `, seed ${study.seed}`}, budget ${study.budget}`],
    ["hash of the study", study.hash],
    ["fixed", fixed || "nothing"],
    ["runs on this page", `${there}.${left}${there === 0 && runs.why ? ` There are none: ${runs.why}` : ""}`],
    ["software", `PARACOSM ${software}; the page asks nothing of a network`],
  ];
  return section("about", "About this page", h("dl", { class: "findings" }, ...rows.flatMap(([name, words]) => [h("dt", {}, name), h("dd", {}, words)])));
}
