// Requirements by test: a row for each requirement, and the tests from left to right in the order of the campaign.

import { Sheet, colour, h } from "./dom";
import type { Store } from "./store";
import { digits, plural } from "./words";

const ROW = 22;
const GAP = 4;

/** The results of a requirement in the tests of a column, the least telling first. */
const RESULTS = ["undecided", "holds", "violated"] as const;

export class Matrix {
  readonly element: HTMLElement;
  private readonly sheet: Sheet;
  private readonly note = h("p", { class: "note", "aria-live": "polite" });
  private readonly legend = h("p", { class: "muted" });
  /** The rows of the tests that pass all filters. */
  private shown: number[] = [];
  private focused = 0;

  constructor(private readonly store: Store) {
    const { robustness } = store.tests;
    this.sheet = new Sheet((context, { width, height }) => this.paint(context, width, height), "The results of all requirements in all tests");
    const { canvas } = this.sheet;
    canvas.style.height = `${robustness.length * (ROW + GAP)}px`;
    canvas.tabIndex = 0;
    const at = ({ offsetX }: MouseEvent) => Math.min(this.shown.length - 1, Math.floor((offsetX / this.sheet.width) * this.shown.length));
    canvas.addEventListener("pointermove", (event) => this.focus(at(event)));
    canvas.addEventListener("click", (event) => this.show(at(event)));
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1, PageDown: 20, PageUp: -20 }[event.key];
      if (step) this.focus(Math.max(0, Math.min(this.shown.length - 1, this.focused + step)));
      else if (event.key === "Enter") this.show(this.focused);
      else return;
      event.preventDefault();
    });
    const names = h("div", { class: "names" }, ...robustness.map(({ id }) => h("div", {}, id)));
    this.element = h("div", { class: "matrix" }, h("div", { class: "strips" }, names, canvas), this.legend, this.note);
    store.onFilter(() => this.choose());
    this.choose();
  }

  private choose() {
    const { mask, tests } = this.store;
    this.shown = [...tests.index.keys()].filter((row) => mask[row]);
    this.focused = Math.max(0, Math.min(this.shown.length - 1, this.focused));
    this.note.textContent = `${plural(this.shown.length, "test")}`;
    this.sheet.draw();
  }

  private focus(place: number) {
    if (place < 0 || place >= this.shown.length) return;
    this.focused = place;
    const { tests } = this.store;
    const row = this.shown[place];
    const results = tests.robustness.map(({ id, values }) => `${id} ${Number.isNaN(values[row]) ? "undecided" : digits(values[row])}`);
    this.note.textContent = `test ${tests.index[row]}: ${this.store.verdictName(row)}; ${results.join(", ")}`;
    this.sheet.draw();
  }

  private show(place: number) {
    if (place >= 0 && place < this.shown.length) this.store.show(this.store.tests.index[this.shown[place]]);
  }

  private paint(context: CanvasRenderingContext2D, width: number, height: number) {
    const { robustness } = this.store.tests;
    const count = this.shown.length;
    if (count === 0) return;
    // A column is at least a pixel wide. With more tests than pixels it shows the worst result of its tests.
    const columns = Math.min(count, Math.floor(width));
    const each = columns < count ? " A column stands for several tests, and shows the worst result of them." : "";
    this.legend.textContent = `Tall and orange: violated. Short and blue: holds. Nothing: undecided.${each} A click plays the test.`;
    robustness.forEach(({ values }, line) => {
      const top = line * (ROW + GAP);
      context.fillStyle = colour("grid");
      context.fillRect(0, top, width, ROW);
      for (let column = 0; column < columns; column++) {
        let worst = 0;
        for (let at = Math.floor((column * count) / columns); at < Math.floor(((column + 1) * count) / columns); at++) {
          const value = values[this.shown[at]];
          worst = Math.max(worst, Number.isNaN(value) ? 0 : value < 0 || Object.is(value, -0) ? 2 : 1);
        }
        const result = RESULTS[worst];
        if (result === "undecided") continue;
        context.fillStyle = colour(result === "violated" ? "fail" : "pass");
        const [left, right] = [(column * width) / columns, ((column + 1) * width) / columns];
        const rise = result === "violated" ? ROW : ROW / 3;
        context.fillRect(left, top + ROW - rise, Math.max(1, right - left - (right - left > 3 ? 1 : 0)), rise);
      }
    });
    context.fillStyle = colour("ink");
    context.fillRect(((this.focused + 0.5) * width) / count - 0.5, 0, 1, height);
  }
}
