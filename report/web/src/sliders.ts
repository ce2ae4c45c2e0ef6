// A slider or a list for each coordinate of a test, so that a test can be changed.

import type { Coordinate } from "./data";
import { h } from "./dom";
import { pointed, withUnit } from "./words";

export class Sliders {
  readonly element: HTMLElement;

  /** `changed` hears of each change; its second argument is true once a change is complete. */
  constructor(coordinates: Coordinate[], readonly numbers: number[], changed: (numbers: number[], isDone: boolean) => void) {
    const parts = coordinates.map((coordinate, at) => {
      const set = (text: string, isDone: boolean) => {
        const { range } = coordinate;
        this.numbers[at] = range ? pointed(Number(text), range[1] - range[0], range) : Number(text);
        changed([...this.numbers], isDone);
      };
      if (!coordinate.range) {
        const levels = coordinate.levels ?? [];
        const list = h("select", { change: () => set(list.value, true) }, ...levels.map((level, place) => h("option", { value: place, selected: place === numbers[at] }, coordinate.unit ? `${level} ${coordinate.unit}` : level)));
        return h("label", {}, h("span", {}, coordinate.name), list, h("output", {}));
      }
      const [min, max] = coordinate.range;
      const shown = h("output", {}, withUnit(numbers[at], coordinate.unit));
      const slider = h("input", { type: "range", min, max, step: "any", value: numbers[at], input: () => {
        shown.textContent = withUnit(Number(slider.value), coordinate.unit);
        set(slider.value, false);
      }, change: () => set(slider.value, true) });
      return h("label", {}, h("span", {}, coordinate.name), slider, shown);
    });
    this.element = h("div", { class: "sliders" }, ...parts);
  }
}
