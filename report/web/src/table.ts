// The table of tests, sorted by any column. Only the rows in sight are elements of the page.

import { h } from "./dom";
import { sign } from "./marks";
import type { Store } from "./store";
import { digits, plural } from "./words";

const ROW = 26;
const EXTRA = 8;

interface Column {
  name: string;
  of: (row: number) => number;
  words: (row: number) => string;
}

export class Table {
  readonly element: HTMLElement;
  private order: Uint32Array = new Uint32Array();
  private sorted = 0;
  private isDown = false;
  private readonly columns: Column[];
  private readonly body = h("tbody");
  private readonly head: HTMLElement;
  private readonly scroll: HTMLElement;
  private readonly note = h("p", { class: "note" });
  private focused = 0;

  constructor(private readonly store: Store) {
    const { page, tests } = store;
    this.columns = [
      { name: "test", of: (row) => tests.index[row], words: (row) => String(tests.index[row]) },
      { name: "verdict", of: (row) => tests.verdict[row], words: (row) => `${sign(store.verdictName(row))} ${store.verdictName(row)}` },
      ...page.coordinates.map((coordinate, at): Column => ({ name: coordinate.label, of: (row) => tests.coordinates[at][row], words: (row) => (coordinate.levels ? store.valueOf(at, row) : digits(tests.coordinates[at][row])) })),
      ...tests.robustness.map(({ id, values }): Column => ({ name: `robustness of ${id}`, of: (row) => values[row], words: (row) => (Number.isNaN(values[row]) ? "undecided" : digits(values[row])) })),
      { name: "impact (m/s)", of: (row) => tests.impact[row], words: (row) => (Number.isNaN(tests.impact[row]) ? "" : digits(tests.impact[row])) },
    ];
    this.head = h("tr", {}, ...this.columns.map(({ name }, at) => h("th", { scope: "col" }, h("button", { type: "button", click: () => this.sort(at) }, name))));
    const table = h("table", { id: "table", "aria-rowcount": tests.rows }, h("thead", {}, this.head), this.body);
    this.scroll = h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Table of tests", scroll: () => this.fill(), keydown: (event: KeyboardEvent) => this.key(event) }, table);
    this.element = h("div", {}, this.scroll, this.note);
    new ResizeObserver(() => this.fill()).observe(this.scroll);
    store.onFilter(() => this.arrange());
    this.arrange();
  }

  /** True if the user has sorted or scrolled the table. */
  get isArranged(): boolean {
    return this.sorted !== 0 || this.isDown || this.scroll.scrollTop > 0;
  }

  private sort(column: number) {
    this.isDown = column === this.sorted ? !this.isDown : false;
    this.sorted = column;
    this.arrange();
  }

  private arrange() {
    const { mask, tests, kept } = this.store;
    const rows = new Uint32Array(kept);
    let count = 0;
    for (let i = 0; i < tests.rows; i++) if (mask[i]) rows[count++] = i;
    const { of } = this.columns[this.sorted];
    const turn = this.isDown ? -1 : 1;
    // Unknown numbers come last.
    this.order = this.sorted === 0 && !this.isDown ? rows : rows.sort((a, b) => {
      const [x, y] = [of(a), of(b)];
      if (Number.isNaN(x) || Number.isNaN(y)) return Number(Number.isNaN(x)) - Number(Number.isNaN(y)) || a - b;
      return turn * (x - y) || a - b;
    });
    [...this.head.children].forEach((cell, at) => (at === this.sorted ? cell.setAttribute("aria-sort", this.isDown ? "descending" : "ascending") : cell.removeAttribute("aria-sort")));
    this.focused = 0;
    this.scroll.scrollTop = 0;
    const { all, rows: there } = this.store.page.tests;
    this.note.textContent = there < all ? `The page has ${plural(there, "test")} of ${all.toLocaleString("en")}; failing tests are the last that it leaves out. trials.csv has all tests.` : "";
    this.fill();
  }

  private fill() {
    const first = Math.max(0, Math.floor(this.scroll.scrollTop / ROW) - EXTRA);
    const last = Math.min(this.order.length, first + Math.ceil((this.scroll.clientHeight || 400) / ROW) + 2 * EXTRA);
    const pad = (rows: number) => (rows > 0 ? [h("tr", { "aria-hidden": "true" }, h("td", { colspan: this.columns.length, class: "pad" }))] : []);
    const before = pad(first);
    const after = pad(this.order.length - last);
    before.forEach((row) => (row.style.height = `${first * ROW}px`));
    after.forEach((row) => (row.style.height = `${(this.order.length - last) * ROW}px`));
    const rows: HTMLElement[] = [];
    for (let at = first; at < last; at++) {
      const row = this.order[at];
      const index = this.store.tests.index[row];
      const cells = this.columns.map(({ words }, column) => h("td", column === 1 ? { class: `verdict ${this.store.verdictName(row)}` } : {}, words(row)));
      rows.push(h("tr", { "data-index": index, class: at === this.focused ? "focused" : "", click: () => this.store.show(index) }, ...cells));
    }
    this.body.replaceChildren(...before, ...rows, ...after);
  }

  private key(event: KeyboardEvent) {
    const page = Math.max(1, Math.floor(this.scroll.clientHeight / ROW) - 2);
    const step: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page };
    if (event.key === "Enter" && event.target === this.scroll && this.order.length > 0) return this.store.show(this.store.tests.index[this.order[this.focused]]);
    if (step[event.key] === undefined) return;
    event.preventDefault();
    this.focused = Math.min(this.order.length - 1, Math.max(0, this.focused + step[event.key]));
    const [top, bottom] = [this.focused * ROW, (this.focused + 2) * ROW];
    if (top < this.scroll.scrollTop) this.scroll.scrollTop = top;
    else if (bottom > this.scroll.scrollTop + this.scroll.clientHeight - ROW) this.scroll.scrollTop = bottom - this.scroll.clientHeight + ROW;
    this.fill();
  }
}
