// An element at the mark of each failing test of a map, so that other programs find failing tests. The table of tests does the same by keyboard, so
// that these elements are no stops of the tab key.

import { h } from "./dom";
import type { Store } from "./store";

/** The greatest number of failing tests of a map with an element of their own. */
const MOST = 500;

export class Spots {
  private readonly spots: { row: number; element: HTMLElement }[];

  /** Makes the elements of the failing tests among these rows. */
  constructor(private readonly store: Store, rows: Uint32Array) {
    const fail = store.page.verdicts.findIndex(({ name }) => name === "fail");
    this.spots = [...rows.filter((row) => store.tests.verdict[row] === fail).slice(0, MOST)].map((row) => {
      const index = store.tests.index[row];
      const element = h("button", { type: "button", class: "spot", tabindex: -1, "aria-hidden": "true", "data-test": index, click: (event: Event) => {
        event.stopPropagation();
        store.show(index);
      } });
      return { row, element };
    });
  }

  get elements(): HTMLElement[] {
    return this.spots.map(({ element }) => element);
  }

  /** Puts the elements at the places of their tests on a map of this size, and hides the elements of tests that the map does not show. */
  place(axes: [number, number], x: (value: number) => number, y: (value: number) => number, [width, height]: [number, number]) {
    const [across, up] = axes.map((at) => this.store.tests.coordinates[at]);
    for (const { row, element } of this.spots) {
      const [left, top] = [x(across[row]), y(up[row])];
      element.hidden = !this.store.mask[row] || left < 0 || left > width || top < 0 || top > height;
      Object.assign(element.style, { left: `${left}px`, top: `${top}px` });
    }
  }
}
