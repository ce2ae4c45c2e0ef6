// The page: reads its data, and shows the first screen before all else.

import "./style.css";
import { type Document as Page, readDocument, readRun, readTests } from "./data";
import { forgetThemes, h, themeButton } from "./dom";
import { Film } from "./film";
import { MapView } from "./map";
import { Matrix } from "./matrix";
import { Parallel } from "./parallel";
import * as sections from "./sections";
import { pageByNow, progress } from "./server";
import { Store } from "./store";
import { Table } from "./table";

/** What a page keeps when it is made again. */
interface Kept {
  axes: [number, number] | null;
  scroll: number;
  /** The new tests that were run from the page. */
  tried: Store["tried"];
}

async function start(root: HTMLElement, kept: Kept = { axes: null, scroll: 0, tried: [] }) {
  const page = await readDocument();
  const tests = await readTests(page.tests);
  const film = new Film(() => store);
  const store: Store = new Store(page, tests, (index) => void film.show(index), (index) => readRun(page, index), (numbers) => void film.attempt(numbers));
  store.tried.push(...kept.tried);
  const { study } = page;
  const map = page.axes === null ? null : new MapView(store, kept.axes);
  const canTry = page.served && page.coordinates.length > 0;
  const effects = page.without_effect.map(({ name, why }) => h("li", {}, h("strong", {}, name), ` had no effect: ${why}`));
  const unfinished = h("p", { class: "unfinished", hidden: !study.unfinished }, soFar(page, page.tests.all));
  root.replaceChildren(
    h("header", { class: "top" }, h("h1", {}, study.title),
      canTry ? h("button", { type: "button", class: "quiet", click: () => store.attempt(store.middle()) }, "New test") : null, themeButton()),
    sections.verdict(page),
    ...[sections.changed(page)].filter((part) => part !== null),
    unfinished,
    effects.length > 0 ? h("ul", { class: "effects" }, ...effects) : h("span", { hidden: true }),
    h("p", { class: "note", hidden: map !== null }, sections.withoutMap(page) ?? ""),
    h("div", { class: "first" },
      ...[sections.worstCard(store), map ? h("section", { class: "card" }, h("h2", {}, "Failure map"), map.element) : null].filter((part) => part !== null)),
    h("p", { class: "command muted" }, `study ${study.hash}, ${study.strategy}, ${page.tests.all} tests. `, "This command repeats it: ", h("code", {}, `${study.program} repeat ${study.folder}${study.trusting}`)),
    film.dialog,
  );
  // The rest follows after the first picture.
  requestAnimationFrame(() => setTimeout(() => {
    root.dataset.first = performance.now().toFixed(0);
    const table = new Table(store);
    const more = [
      sections.changes(store),
      sections.modes(store),
      tests.rows > 1 && page.coordinates.length > 0 ? sections.section("parameters", "All parameters: drag along an axis to filter", new Parallel(store).element) : null,
      sections.findings(page),
      sections.growth(page),
      sections.requirements(store),
      tests.robustness.length > 0 && tests.rows > 1 ? sections.section("matrix", "Requirements by test, in the order of the campaign", new Matrix(store).element) : null,
      sections.section("all-tests", "Tests: click a row to play it", table.element),
      sections.results(page),
      sections.about(page),
    ];
    root.append(...more.filter((part) => part !== null));
    root.dataset.ready = "true";
    if (kept.scroll > 0) scrollTo(0, kept.scroll);
    // Not every browser says when it is idle.
    setTimeout(() => map?.prepare(), 300);
    if (page.served && study.unfinished) {
      follow(page, unfinished, {
        isPlaying: () => film.isBusy,
        // A page that is made again forgets what the user has arranged.
        isBusy: () => store.isFiltered || store.tried.length > 0 || film.isBusy || table.isArranged || root.querySelector("details[open]") !== null || (map?.isZoomed ?? false) || root.querySelector(":focus-visible") !== null,
        restart: () => start(root, { axes: map?.shown ?? null, scroll: scrollY, tried: store.tried }),
      });
    }
  }));
}

const soFar = (page: Page, tests: number) => `The campaign has not ended: ${tests.toLocaleString("en")} of at most ${page.study.budget.toLocaleString("en")} tests have run.`;

/** Follows a campaign that still runs: tells of new tests, and shows them unless the user is busy with the tests on the page. */
function follow(page: Page, place: HTMLElement, part: { isPlaying: () => boolean; isBusy: () => boolean; restart: () => Promise<void> }) {
  const shown = page.tests.all;
  let next = 0;
  const later = () => (next = window.setTimeout(look, pause));
  const ended = (error: unknown) => {
    place.textContent = `The page no longer follows the campaign: ${error instanceof Error ? error.message : String(error)}`;
  };
  const refresh = async (isAsked: boolean) => {
    // The page that is made again looks by itself.
    window.clearTimeout(next);
    const begun = performance.now();
    const fresh = await pageByNow();
    // The user may have begun something meanwhile.
    if (isAsked ? part.isPlaying() : part.isBusy()) return void later();
    for (const id of ["document", "tests"]) document.getElementById(id)!.textContent = fresh.getElementById(id)!.textContent;
    forgetThemes();
    await part.restart();
    // A page that takes long to make is made less often.
    pause = Math.max(PAUSE, 4 * (performance.now() - begun));
  };
  const look = async () => {
    try {
      const { tests, unfinished } = await progress();
      if ((tests > shown || !unfinished) && !part.isBusy()) return await refresh(false);
      place.replaceChildren(soFar(page, tests), tests > shown ? h("button", { type: "button", class: "quiet", click: () => void refresh(true).catch(ended) }, `Show ${tests - shown} new tests`) : "");
    } catch (error) {
      return ended(error);
    }
    later();
  };
  later();
}

/** The milliseconds between two looks at a campaign that still runs. */
const PAUSE = 1500;
let pause = PAUSE;

const root = document.getElementById("page");
if (root) {
  start(root).catch((error: unknown) => {
    root.replaceChildren(h("p", { class: "headline" }, `This page cannot be shown: ${error instanceof Error ? error.message : String(error)}. It needs a browser from 2023 or later.`));
  });
}
