// The page: reads its data, and shows the first screen before all else.

import "./style.css";
import { readDocument, readRun, readTests } from "./data";
import { h, themeButton } from "./dom";
import { Film } from "./film";
import { MapView } from "./map";
import { Parallel } from "./parallel";
import * as sections from "./sections";
import { Store } from "./store";
import { Table } from "./table";

async function start(root: HTMLElement) {
  const page = await readDocument();
  const tests = await readTests(page.tests);
  const film = new Film(() => store);
  const store: Store = new Store(page, tests, (index) => void film.show(index), (index) => readRun(page, index));
  const { study } = page;
  const map = page.axes === null ? null : new MapView(store);
  const effects = page.without_effect.map(({ name, why }) => h("li", {}, h("strong", {}, name), ` had no effect: ${why}`));
  root.replaceChildren(
    h("header", { class: "top" }, h("h1", {}, study.title), themeButton()),
    sections.verdict(page),
    study.unfinished ? h("p", { class: "unfinished" }, `The campaign has not ended: ${page.tests.all.toLocaleString("en")} of at most ${study.budget.toLocaleString("en")} tests have run.`) : h("span", { hidden: true }),
    effects.length > 0 ? h("ul", { class: "effects" }, ...effects) : h("span", { hidden: true }),
    h("div", { class: "first" },
      ...[sections.worstCard(store), map ? h("section", { class: "card" }, h("h2", {}, "Failure map"), map.element) : null].filter((part) => part !== null)),
    h("p", { class: "command muted" }, `study ${study.hash}, ${study.strategy}, ${page.tests.all} tests. `, "This command repeats it: ", h("code", {}, `${study.program} repeat ${study.folder}${study.trusting}`)),
    film.dialog,
  );
  // The rest follows after the first picture.
  requestAnimationFrame(() => setTimeout(() => {
    root.dataset.first = performance.now().toFixed(0);
    const more = [
      sections.changes(store),
      sections.modes(store),
      tests.rows > 1 && page.coordinates.length > 0 ? sections.section("parameters", "All parameters: drag along an axis to filter", new Parallel(store).element) : null,
      sections.findings(page),
      sections.growth(page),
      sections.requirements(store),
      sections.section("tests", "Tests: click a row to play it", new Table(store).element),
      sections.results(page),
      sections.about(page),
    ];
    root.append(...more.filter((part) => part !== null));
    root.dataset.ready = "true";
    // Not every browser says when it is idle.
    setTimeout(() => map?.prepare(), 300);
  }));
}

const root = document.getElementById("page");
if (root) {
  start(root).catch((error: unknown) => {
    root.replaceChildren(h("p", { class: "headline" }, `This page cannot be shown: ${error instanceof Error ? error.message : String(error)}. It needs a browser from 2023 or later.`));
  });
}
