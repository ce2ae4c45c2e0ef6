// Parallel coordinates: an axis for each parameter, a line for each test. A range on an axis filters all parts of the page.

import { scaleLinear } from "d3-scale";
import { colour, h, Sheet } from "./dom";
import type { Store } from "./store";
import { digits, plural } from "./words";

const TOP = 34;
const BOTTOM = 16;
const SIDE = 48;
/** With more tests, lines that lie close together are drawn as one. */
const MOST_LINES = 4000;
const BINS = 48;

export class Parallel {
  readonly element: HTMLElement;
  private readonly sheet: Sheet;
  private drag: { axis: number; from: number; to: number } | null = null;
  private readonly count = h("output", { class: "count", "aria-live": "polite" });
  private readonly bins: Uint8Array[] = [];
  private readonly inputs: { axis: number; lo: HTMLInputElement; hi: HTMLInputElement }[] = [];

  constructor(private readonly store: Store) {
    this.sheet = new Sheet((context) => this.paint(context), "Parallel coordinates: a line for each test");
    const { canvas } = this.sheet;
    canvas.addEventListener("pointerdown", (event) => this.begin(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", () => this.end());
    canvas.addEventListener("pointercancel", () => this.end());
    const rows = store.page.coordinates.map((coordinate, axis) => {
      const field = (side: string) => h("input", { type: "number", step: "any", "aria-label": `${coordinate.name} ${side}`, placeholder: side, change: () => this.typed(axis) });
      const [lo, hi] = [field("at least"), field("at most")];
      this.inputs.push({ axis, lo, hi });
      const words = coordinate.levels ? `${coordinate.name}, by number: ${coordinate.levels.map((level, at) => `${at} is ${level}`).join(", ")}` : coordinate.label;
      return h("label", {}, `${words} `, lo, hi);
    });
    const verdicts = h("select", { "aria-label": "Verdict", change: () => {
      store.verdict = verdicts.value === "" ? null : Number(verdicts.value);
      store.filter();
    } }, h("option", { value: "" }, "all verdicts"), ...store.page.verdicts.map(({ name, tests }, at) => ({ name, tests, at })).filter(({ tests }) => tests > 0).map(({ name, at }) => h("option", { value: at }, name)));
    this.element = h("div", { class: "parallel", id: "parallel" },
      h("div", { class: "controls" }, verdicts, h("button", { type: "button", class: "quiet", click: () => store.clear() }, "Remove all filters"), this.count),
      canvas,
      h("p", { class: "muted" }, "Thick and orange: tests that fail. Thin and blue: the others."),
      h("details", {}, h("summary", {}, "Filter by numbers"), h("div", { class: "choices" }, ...rows)),
    );
    store.onFilter(() => {
      this.words();
      if (store.verdict === null) verdicts.value = "";
      for (const { axis, lo, hi } of this.inputs) {
        const range = store.ranges.get(axis);
        if (document.activeElement !== lo) lo.value = range && Number.isFinite(range[0]) ? digits(range[0]) : "";
        if (document.activeElement !== hi) hi.value = range && Number.isFinite(range[1]) ? digits(range[1]) : "";
      }
      this.sheet.draw();
    });
    this.words();
  }

  private words() {
    const { kept, tests } = this.store;
    this.count.textContent = kept === tests.rows ? plural(kept, "test") : `${kept.toLocaleString("en")} of ${plural(tests.rows, "test")}`;
  }

  private typed(axis: number) {
    const { lo, hi } = this.inputs[axis];
    const [from, to] = [lo.value === "" ? -Infinity : Number(lo.value), hi.value === "" ? Infinity : Number(hi.value)];
    if (from === -Infinity && to === Infinity) this.store.ranges.delete(axis);
    else this.store.ranges.set(axis, [from, to]);
    this.store.filter();
  }

  private xOf(axis: number): number {
    const axes = this.store.page.coordinates.length;
    return axes === 1 ? this.sheet.width / 2 : SIDE + (axis * (this.sheet.width - 2 * SIDE)) / (axes - 1);
  }

  private scale(axis: number) {
    const { range, levels } = this.store.page.coordinates[axis];
    const [lo, hi] = range ?? [-0.5, (levels?.length ?? 1) - 0.5];
    return scaleLinear([lo, hi], [this.sheet.height - BOTTOM, TOP]);
  }

  private begin(event: PointerEvent) {
    const axes = this.store.page.coordinates.length;
    const axis = Array.from({ length: axes }, (_, at) => at).reduce((best, at) => (Math.abs(this.xOf(at) - event.offsetX) < Math.abs(this.xOf(best) - event.offsetX) ? at : best), 0);
    if (Math.abs(this.xOf(axis) - event.offsetX) > 24) return;
    this.sheet.canvas.setPointerCapture(event.pointerId);
    this.drag = { axis, from: event.offsetY, to: event.offsetY };
  }

  private move(event: PointerEvent) {
    if (!this.drag) return;
    this.drag.to = event.offsetY;
    this.sheet.draw();
  }

  private end() {
    const { drag } = this;
    if (!drag) return;
    this.drag = null;
    // A click removes the range of an axis.
    if (Math.abs(drag.to - drag.from) < 4) this.store.ranges.delete(drag.axis);
    else {
      const scale = this.scale(drag.axis);
      const ends = [scale.invert(drag.from), scale.invert(drag.to)];
      this.store.ranges.set(drag.axis, [Math.min(...ends), Math.max(...ends)]);
    }
    this.store.filter();
  }

  private paint(context: CanvasRenderingContext2D) {
    const { store } = this;
    const { page, tests, mask } = store;
    const axes = page.coordinates.length;
    const scales = page.coordinates.map((_, axis) => this.scale(axis));
    const fails = page.verdicts.findIndex(({ name }) => name === "fail");
    for (const isFailing of [false, true]) {
      context.strokeStyle = isFailing ? colour("fail") : colour("pass");
      context.lineWidth = isFailing ? 1.8 : 0.8;
      const rows: number[] = [];
      for (let i = 0; i < tests.rows; i++) if (mask[i] && (tests.verdict[i] === fails) === isFailing) rows.push(i);
      if (rows.length > MOST_LINES && axes > 1) this.paintBins(context, rows);
      else {
        context.globalAlpha = Math.min(0.7, Math.max(0.06, 60 / Math.max(1, rows.length)));
        for (const row of rows) {
          context.beginPath();
          for (let axis = 0; axis < axes; axis++) {
            const [x, y] = [this.xOf(axis), scales[axis](tests.coordinates[axis][row])];
            // With a single axis, a test is a short line on it.
            if (axis === 0) context.moveTo(axes === 1 ? x - 14 : x, y);
            if (axis > 0 || axes === 1) context.lineTo(axes === 1 ? x + 14 : x, y);
          }
          context.stroke();
        }
      }
      context.globalAlpha = 1;
    }
    for (let axis = 0; axis < axes; axis++) this.paintAxis(context, axis, scales[axis]);
  }

  /** The part of an axis in which each test lies, from its top. */
  private binsOf(axis: number): Uint8Array {
    const { range, levels } = this.store.page.coordinates[axis];
    const [lo, hi] = range ?? [-0.5, (levels?.length ?? 1) - 0.5];
    const bin = (value: number) => Math.min(BINS - 1, Math.max(0, Math.floor(((hi - value) / (hi - lo)) * BINS)));
    return (this.bins[axis] ??= Uint8Array.from(this.store.tests.coordinates[axis], bin));
  }

  /** Draws one line for all lines between the same two parts of neighbouring axes. */
  private paintBins(context: CanvasRenderingContext2D, rows: number[]) {
    const span = this.sheet.height - BOTTOM - TOP;
    for (let axis = 0; axis + 1 < this.store.page.coordinates.length; axis++) {
      const counts = new Uint32Array(BINS * BINS);
      const [before, after] = [this.binsOf(axis), this.binsOf(axis + 1)];
      let most = 0;
      for (const row of rows) most = Math.max(most, ++counts[before[row] * BINS + after[row]]);
      const [x0, x1] = [this.xOf(axis), this.xOf(axis + 1)];
      for (const level of [0.25, 0.5, 1]) {
        context.globalAlpha = 0.25 * level;
        context.beginPath();
        counts.forEach((count, place) => {
          const share = count / most;
          if (count === 0 || share > level || share <= level / 2 - (level === 0.25 ? 1 : 0)) return;
          context.moveTo(x0, TOP + ((Math.floor(place / BINS) + 0.5) * span) / BINS);
          context.lineTo(x1, TOP + (((place % BINS) + 0.5) * span) / BINS);
        });
        context.stroke();
      }
    }
  }

  private paintAxis(context: CanvasRenderingContext2D, axis: number, scale: ReturnType<Parallel["scale"]>) {
    const { label, levels } = this.store.page.coordinates[axis];
    const x = this.xOf(axis);
    const axes = this.store.page.coordinates.length;
    context.fillStyle = colour("ink");
    context.fillRect(x - 0.5, TOP, 1, this.sheet.height - BOTTOM - TOP);
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "bottom";
    const isFirst = axis === 0 && axes > 1;
    const isLast = axis === axes - 1 && axes > 1;
    context.textAlign = isFirst ? "left" : isLast ? "right" : "center";
    context.fillText(label, isFirst ? 4 : isLast ? this.sheet.width - 4 : x, TOP - (axes > 6 && axis % 2 ? 18 : 4), (1.9 * this.sheet.width) / axes);
    context.font = "10px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    const ticks = levels ? levels.map((_, at) => at) : scale.ticks(5);
    for (const tick of ticks) {
      const text = levels ? levels[tick] : String(tick);
      const y = scale(tick);
      context.fillStyle = colour("halo");
      context.fillRect(x + 3, y - 6, context.measureText(text).width + 4, 12);
      context.fillStyle = colour("muted");
      context.fillText(text, x + 5, y);
    }
    const range = this.drag?.axis === axis ? [scale.invert(this.drag.from), scale.invert(this.drag.to)] : this.store.ranges.get(axis);
    if (!range) return;
    const [lo, hi] = [Math.max(Math.min(...range), scale.domain()[0]), Math.min(Math.max(...range), scale.domain()[1])];
    context.fillStyle = colour("brush");
    context.fillRect(x - 9, scale(hi), 18, scale(lo) - scale(hi));
    context.strokeStyle = colour("ink");
    context.strokeRect(x - 9, scale(hi), 18, scale(lo) - scale(hi));
  }
}
