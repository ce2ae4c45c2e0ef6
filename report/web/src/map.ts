// The failure map: tests as marks over two coordinates, on the estimated probability of failure.

import { quadtree, type Quadtree } from "d3-quadtree";
import { scaleLinear, type ScaleLinear } from "d3-scale";
import { select } from "d3-selection";
import { zoom, zoomIdentity, type ZoomTransform } from "d3-zoom";
import { plain, type Grid } from "./data";
import { colour, h, Sheet } from "./dom";
import { mapped } from "./server";
import { pointed, reason } from "./words";
import { Spots } from "./spots";
import type { Store } from "./store";
import { type Line, paintTests } from "./cloud";
import { mark, sign, verdictColour } from "./marks";

const MARGIN = { left: 62, right: 14, top: 12, bottom: 46 };
/** The distance in pixels within which a test answers to the pointer. */
const NEAR = 14;

/** A map of the tests with one value of a discrete parameter, or of all tests. */
interface Facet {
  title: string | null;
  rows: Uint32Array;
  left: number;
  top: number;
  width: number;
  height: number;
  tree: Quadtree<number> | null;
  /** The element over the map that hears of the pointer. */
  pane: HTMLElement;
  spots: Spots;
}

type Scale = ScaleLinear<number, number>;

/** The place of the pointer in an element. */
function within(element: HTMLElement, event: MouseEvent): [number, number] {
  const { left, top } = element.getBoundingClientRect();
  return [event.clientX - left, event.clientY - top];
}

const line = (scale: Scale): Line => ({ scale: scale(1) - scale(0), offset: scale(0) });

export class MapView {
  readonly element: HTMLElement;
  private axes: [number, number];
  private facetBy = -1;
  private byMode = true;
  /** True if a map shows tests as pixels. */
  private hasPixels = false;
  private transform: ZoomTransform = zoomIdentity;
  private facets: Facet[] = [];
  private size = "";
  private hovered: { facet: Facet; row: number; x: number; y: number } | null = null;
  private readonly panes = h("div", { class: "panes" });
  private readonly sheet: Sheet;
  private readonly overlay: Sheet;
  private readonly tip = h("div", { class: "tip", hidden: true });
  private readonly note = h("p", { class: "note" });
  private readonly images = new Map<Grid, HTMLCanvasElement>();
  /** What the viewer said of the pairs that the page did not have, by their positions; empty while it has not answered. */
  private readonly asked = new Map<string, string>();

  /** `shown` are the axes that the map shows first, in place of the axes of the page. */
  constructor(private readonly store: Store, shown: [number, number] | null = null) {
    const { page } = store;
    const continuous = page.coordinates.map((_, at) => at).filter((at) => page.coordinates[at].range);
    this.axes = shown ?? page.axes ?? [continuous[0], continuous[1] ?? continuous[0]];
    this.sheet = new Sheet((context) => this.paint(context), "Failure map: the tests over two parameters. The table of tests below has the same tests.");
    this.overlay = new Sheet((context) => this.highlight(context), "The test under the pointer");
    this.overlay.canvas.setAttribute("aria-hidden", "true");
    const choose = (axis: 0 | 1) => {
      const options = continuous.map((at) => h("option", { value: at, selected: at === this.axes[axis] }, page.coordinates[at].label));
      return h("select", { id: axis === 0 ? "x-axis" : "y-axis", "aria-label": axis === 0 ? "Horizontal axis" : "Vertical axis", change: (event: Event) => {
        this.axes[axis] = Number((event.target as HTMLSelectElement).value);
        this.changed();
      } }, ...options);
    };
    const discrete = page.coordinates.map((_, at) => at).filter((at) => page.coordinates[at].levels);
    const controls = h("div", { class: "controls" },
      h("label", {}, "across ", choose(0)),
      h("label", {}, "up ", choose(1)),
      discrete.length === 0 ? null : h("label", {}, "a map for each ", h("select", { "aria-label": "Facets", change: (event: Event) => {
        this.facetBy = Number((event.target as HTMLSelectElement).value);
        this.changed();
      } }, h("option", { value: -1 }, "(none)"), ...discrete.map((at) => h("option", { value: at }, page.coordinates[at].name)))),
      page.modes.modes.length < 2 ? null : h("label", {}, h("input", { type: "checkbox", checked: true, change: (event: Event) => {
        this.byMode = (event.target as HTMLInputElement).checked;
        this.sheet.draw();
      } }), " failure modes"),
      h("button", { type: "button", class: "quiet", click: () => this.reset() }, "Whole map"),
    );
    const canvases = h("div", { class: "canvases" }, this.sheet.canvas, this.overlay.canvas, this.panes, this.tip);
    this.element = h("div", { class: "map", id: "map" }, controls, canvases, this.note);
    store.onFilter(() => {
      this.sheet.draw();
      this.overlay.draw();
    });
    let isFollowing = false;
    this.zooming = zoom<HTMLElement, unknown>().scaleExtent([1, 64]).on("zoom", (event: { transform: ZoomTransform }) => {
      if (isFollowing) return;
      this.transform = event.transform;
      // All maps show the same part.
      isFollowing = true;
      for (const { pane } of this.facets) select<HTMLElement, unknown>(pane).call(this.zooming.transform, event.transform);
      isFollowing = false;
      this.leave();
      this.sheet.draw();
    });
    this.words();
  }

  private readonly zooming;

  get shown(): [number, number] {
    return this.axes;
  }

  /** Prepares the answers to the pointer, which takes a while if there are many tests. */
  prepare() {
    for (const facet of this.facets) this.treeOf(facet);
  }

  private reset() {
    const [first] = this.facets;
    if (first) select<HTMLElement, unknown>(first.pane).call(this.zooming.transform, zoomIdentity);
  }

  private changed() {
    this.size = "";
    this.reset();
    this.sheet.draw();
  }

  private words() {
    const { page } = this.store;
    const [x, y] = this.axes;
    const grid = this.grid();
    const hole = this.hole();
    const isWhole = page.coordinates.length === 2;
    const parts = [
      page.served ? "Click an empty place to run a test there." : null,
      grid ? "Shade: estimated probability of failure." : this.withoutShade(),
      hole ? (isWhole ? "Dashed: the largest empty box, which was never tested." : "Dashed: the largest empty box; other parameters bound it, too.") : null,
      x === y ? "Both axes show the same parameter." : null,
      this.hasPixels && this.byMode && page.modes.modes.length > 1 ? "With so many tests, a failure mode is a colour; zoom in to see its marks." : null,
    ];
    this.note.textContent = parts.filter(Boolean).join(" ");
  }

  private grid(): Grid | null {
    const [x, y] = this.axes;
    const { page } = this.store;
    const grid = page.maps.find(({ axes }) => (axes[0] === x && axes[1] === y) || (axes[0] === y && axes[1] === x)) ?? null;
    // A viewer makes the other maps when somebody looks at them. Without a first map, it has no model of the failures.
    if (!grid && page.served && x !== y && page.maps.length > 0) void this.ask([Math.min(x, y), Math.max(x, y)]);
    return grid;
  }

  private async ask(pair: [number, number]) {
    const { page } = this.store;
    if (this.asked.has(String(pair))) return;
    this.asked.set(String(pair), "");
    try {
      const grid = await mapped(pair);
      if (grid) page.maps.push(grid);
      this.asked.set(String(pair), "There is no estimate for this pair.");
    } catch (error) {
      this.asked.set(String(pair), `There is no estimate for this pair: ${reason(error)}.`);
    }
    this.sheet.draw();
  }

  /** Says why the map has no shade. */
  private withoutShade(): string | null {
    const { page } = this.store;
    const [x, y] = this.axes;
    if (x === y) return null;
    if (page.maps.length === 0) return "There is no estimate of the probability of failure: it needs tests that fail and tests that pass.";
    if (!page.served) return "The page has no estimate for this pair; `map` draws it.";
    return this.asked.get([Math.min(x, y), Math.max(x, y)].join()) || "The estimate for this pair is being made.";
  }

  private hole(): [[number, number], [number, number]] | null {
    const { hole, coordinates } = this.store.page;
    const [x, y] = this.axes.map((at) => coordinates[at].name);
    return hole && hole[x] && hole[y] ? [hole[x], hole[y]] : null;
  }

  /** True if the user looks at a part of the map. */
  get isZoomed(): boolean {
    return this.transform.k !== 1;
  }

  /** The scales of a map in pixels from its corner, before it is zoomed. */
  private base(facet: Facet): [Scale, Scale] {
    const [x, y] = this.axes.map((at) => this.store.page.coordinates[at].range ?? [0, 1]);
    return [scaleLinear(x, [0, facet.width]), scaleLinear(y, [facet.height, 0])];
  }

  /** The scales of a map as it is zoomed. */
  private scales(facet: Facet): [Scale, Scale] {
    const [x, y] = this.base(facet);
    return [this.transform.rescaleX(x), this.transform.rescaleY(y)];
  }

  /** Lays the facets out, and sorts the tests into them. */
  private arrange() {
    const { width, height } = this.sheet;
    const size = `${width}x${height}`;
    if (size === this.size) return;
    this.size = size;
    const { tests, page } = this.store;
    const levels = this.facetBy < 0 ? [null] : (page.coordinates[this.facetBy].levels ?? [null]);
    const columns = Math.ceil(Math.sqrt(levels.length));
    const rows = Math.ceil(levels.length / columns);
    const title = this.facetBy < 0 ? 0 : 18;
    const [w, hgt] = [width / columns, height / rows];
    this.leave();
    this.facets = levels.map((level, number): Facet => {
      const [column, row] = [number % columns, Math.floor(number / columns)];
      const all = new Uint32Array(tests.rows);
      let count = 0;
      for (let i = 0; i < tests.rows; i++) if (this.facetBy < 0 || tests.coordinates[this.facetBy][i] === number) all[count++] = i;
      const shown = all.slice(0, count);
      return {
        title: level === null ? null : `${page.coordinates[this.facetBy].name} ${level}`,
        rows: shown,
        left: column * w + MARGIN.left,
        top: row * hgt + MARGIN.top + title,
        width: Math.max(20, w - MARGIN.left - MARGIN.right),
        height: Math.max(20, hgt - MARGIN.top - MARGIN.bottom - title),
        tree: null,
        pane: h("div", { class: "pane" }),
        spots: new Spots(this.store, shown),
      };
    });
    const [{ width: inner, height: tall }] = this.facets;
    this.zooming.extent([[0, 0], [inner, tall]]).translateExtent([[0, 0], [inner, tall]]);
    for (const facet of this.facets) {
      const { pane } = facet;
      Object.assign(pane.style, { left: `${facet.left}px`, top: `${facet.top}px`, width: `${facet.width}px`, height: `${facet.height}px` });
      pane.addEventListener("pointermove", (event) => this.hover(facet, event));
      pane.addEventListener("pointerleave", () => this.leave());
      pane.addEventListener("click", (event) => {
        if (this.hovered) this.store.show(this.store.tests.index[this.hovered.row]);
        else if (this.store.page.served) this.store.attempt(this.numbersAt(facet, ...within(pane, event)));
      });
      select<HTMLElement, unknown>(pane).call(this.zooming).on("dblclick.zoom", null);
      pane.append(...facet.spots.elements);
    }
    this.panes.replaceChildren(...this.facets.map(({ pane }) => pane));
    // The new maps show the part that the maps before showed, as far as their size allows.
    const [{ pane }] = this.facets;
    select<HTMLElement, unknown>(pane).call(this.zooming.transform, this.transform);
  }

  private paint(context: CanvasRenderingContext2D) {
    this.arrange();
    this.hasPixels = false;
    for (const facet of this.facets) this.paintFacet(context, facet);
    this.words();
  }

  private paintFacet(context: CanvasRenderingContext2D, facet: Facet) {
    const [x, y] = this.scales(facet);
    const { left, top, width, height, rows } = facet;
    context.save();
    context.translate(left, top);
    context.beginPath();
    context.rect(0, 0, width, height);
    context.clip();
    context.fillStyle = colour("plot");
    context.fillRect(0, 0, width, height);
    this.paintShade(context, x, y);
    const isDotted = paintTests(context, this.store, { width, height, rows, x: line(x), y: line(y), axes: this.axes, byMode: this.byMode });
    this.hasPixels ||= isDotted;
    const hole = this.hole();
    if (hole) {
      const [[x0, x1], [y0, y1]] = hole;
      context.strokeStyle = colour("ink");
      context.lineWidth = 1.5;
      context.setLineDash([6, 4]);
      context.strokeRect(x(x0), y(y1), x(x1) - x(x0), y(y0) - y(y1));
      context.setLineDash([]);
      if (this.store.page.coordinates.length === 2 && x(x1) - x(x0) > 8) {
        context.fillStyle = colour("ink");
        context.font = "11px system-ui, sans-serif";
        context.textAlign = "left";
        context.textBaseline = "bottom";
        context.fillText("never tested", Math.min(x(x0), width - 70), y(y1) - 3);
      }
    }
    context.restore();
    facet.spots.place(this.axes, x, y, [width, height]);
    this.paintAxes(context, facet, x, y);
  }

  private paintShade(context: CanvasRenderingContext2D, x: ScaleLinear<number, number>, y: ScaleLinear<number, number>) {
    const grid = this.grid();
    if (!grid || this.axes[0] === this.axes[1]) return;
    const image = this.image(grid);
    const isTurned = grid.axes[0] !== this.axes[0];
    const [nx, ny] = grid.size;
    const [rx, ry] = this.axes.map((at) => this.store.page.coordinates[at].range ?? [0, 1]);
    const [x0, x1, y0, y1] = [x(rx[0]), x(rx[1]), y(ry[1]), y(ry[0])];
    context.save();
    context.imageSmoothingEnabled = true;
    // The places are at the edges of the map, so that half a pixel of the image lies outside.
    if (isTurned) {
      context.setTransform(context.getTransform().multiply(new DOMMatrix([0, y0 - y1, x1 - x0, 0, x0, y1])));
    } else {
      context.setTransform(context.getTransform().multiply(new DOMMatrix([x1 - x0, 0, 0, y0 - y1, x0, y1])));
    }
    context.drawImage(image, -0.5 / (nx - 1), -0.5 / (ny - 1), nx / (nx - 1), ny / (ny - 1));
    context.restore();
  }

  private image(grid: Grid): HTMLCanvasElement {
    let canvas = this.images.get(grid);
    if (!canvas) {
      const [nx, ny] = grid.size;
      canvas = h("canvas", { width: nx, height: ny });
      const context = canvas.getContext("2d")!;
      const image = context.createImageData(nx, ny);
      plain(grid.percent).forEach((share, place) => {
        // The shade lies over the ground of the theme: the more opaque, the more tests fail.
        image.data.set([0xd5, 0x5e, 0x00, share === 255 ? 0 : Math.round(1.7 * share)], 4 * place);
      });
      context.putImageData(image, 0, 0);
      this.images.set(grid, canvas);
    }
    return canvas;
  }

  private paintAxes(context: CanvasRenderingContext2D, facet: Facet, x: ScaleLinear<number, number>, y: ScaleLinear<number, number>) {
    const { left, top, width, height, title } = facet;
    const { coordinates } = this.store.page;
    context.save();
    context.translate(left, top);
    context.strokeStyle = colour("line");
    context.fillStyle = colour("muted");
    context.lineWidth = 1;
    context.strokeRect(-0.5, -0.5, width + 1, height + 1);
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "top";
    const xs = x.ticks(Math.max(2, width / 90));
    const ys = y.ticks(Math.max(2, height / 50));
    for (const tick of xs) {
      context.fillRect(Math.round(x(tick)), height, 1, 4);
      context.fillText(String(tick), x(tick), height + 7);
    }
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const tick of ys) {
      context.fillRect(-4, Math.round(y(tick)), 4, 1);
      context.fillText(String(tick), -7, y(tick));
    }
    context.fillStyle = colour("ink");
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillText(coordinates[this.axes[0]].label, width / 2, height + 25, width);
    context.save();
    context.translate(-50, height / 2);
    context.rotate(-Math.PI / 2);
    context.fillText(coordinates[this.axes[1]].label, 0, 0, height);
    context.restore();
    if (title) {
      context.textBaseline = "bottom";
      context.fillText(title, width / 2, -4, width);
    }
    context.restore();
  }

  private hover(facet: Facet, event: PointerEvent) {
    const [px, py] = within(facet.pane, event);
    const found = this.nearest(facet, px, py);
    if (!found) return this.leave();
    this.hovered = found;
    this.overlay.draw();
    facet.pane.style.cursor = "pointer";
    const { store } = this;
    const row = found.row;
    const values = store.valuesOf(row).map(([name, value]) => h("div", {}, `${name} ${value}`));
    const mode = store.tests.mode[row];
    this.tip.replaceChildren(
      h("strong", {}, `test ${store.tests.index[row]}: ${store.verdictName(row)}`),
      ...values.slice(0, 10),
      ...(mode ? [h("div", {}, store.page.modes.modes[mode - 1].words)] : []),
      ...this.chance(facet, px, py),
    );
    this.tip.hidden = false;
    const [left, top] = [facet.left + px, facet.top + py];
    const right = left > this.overlay.width / 2;
    this.tip.style.left = right ? "auto" : `${left + 16}px`;
    this.tip.style.right = right ? `${this.overlay.width - left + 16}px` : "auto";
    this.tip.style.top = `${Math.min(top, this.overlay.height - 140)}px`;
  }

  /** The estimate at a place in words. */
  private chance(facet: Facet, px: number, py: number): HTMLElement[] {
    const grid = this.grid();
    if (!grid) return [];
    const [x, y] = this.scales(facet);
    const at: [number, number] = [x.invert(px), y.invert(py)];
    const place = grid.axes.map((axis, i) => {
      const [lo, hi] = this.store.page.coordinates[axis].range ?? [0, 1];
      const value = axis === this.axes[0] ? at[0] : at[1];
      return Math.round(Math.min(1, Math.max(0, (value - lo) / (hi - lo))) * (grid.size[i] - 1));
    });
    const number = place[1] * grid.size[0] + place[0];
    const share = plain(grid.percent)[number];
    if (share === 255) return [];
    const sure = ["", ", surely more than half", ", surely fewer than half"][plain(grid.decided)[number]];
    return [h("div", { class: "muted" }, `estimate here: ${share} % fail${sure}`)];
  }

  /** The numbers of a new test at a place of a map. Other parameters are those of the nearest test. */
  private numbersAt(facet: Facet, px: number, py: number): number[] {
    const { store } = this;
    const [x, y] = this.scales(facet);
    const [bx, by] = this.base(facet);
    const near = this.treeOf(facet).find(bx(x.invert(px)), by(y.invert(py)));
    const numbers = near === undefined ? store.middle() : store.numbersOf(near);
    [[x, px] as const, [y, py] as const].forEach(([scale, at], i) => {
      // The domain of a scale is what is in sight.
      const [from, to] = scale.domain();
      const range = store.page.coordinates[this.axes[i]].range ?? [0, 1];
      numbers[this.axes[i]] = pointed(scale.invert(at), Math.abs(to - from), range);
    });
    if (this.facetBy >= 0) numbers[this.facetBy] = this.facets.indexOf(facet);
    return numbers;
  }

  private treeOf(facet: Facet): Quadtree<number> {
    const [bx, by] = this.base(facet);
    const [cx, cy] = this.axes.map((at) => this.store.tests.coordinates[at]);
    return (facet.tree ??= quadtree<number>([...facet.rows], (row) => bx(cx[row]), (row) => by(cy[row])));
  }

  private nearest(facet: Facet, px: number, py: number): { facet: Facet; row: number; x: number; y: number } | null {
    const { tests, mask } = this.store;
    const [bx, by] = this.base(facet);
    const [cx, cy] = this.axes.map((at) => tests.coordinates[at]);
    // On the map as it was before it was zoomed.
    const [x, y] = this.scales(facet);
    const row = this.treeOf(facet).find(bx(x.invert(px)), by(y.invert(py)), NEAR / this.transform.k);
    return row === undefined || !mask[row] ? null : { facet, row, x: x(cx[row]), y: y(cy[row]) };
  }

  /** Draws the tests that were run from the page: a diamond with the sign of the verdict. */
  private paintTried(context: CanvasRenderingContext2D) {
    for (const { numbers, verdict } of this.store.tried) {
      const facet = this.facets[this.facetBy < 0 ? 0 : numbers[this.facetBy]];
      if (!facet) continue;
      const [x, y] = this.scales(facet).map((scale, i) => scale(numbers[this.axes[i]]));
      if (x < 0 || y < 0 || x > facet.width || y > facet.height) continue;
      const [left, top] = [facet.left + x, facet.top + y];
      mark(context, 4, left, top, 9, colour("halo"));
      context.strokeStyle = context.fillStyle = verdictColour(verdict);
      context.lineWidth = 1.5;
      context.beginPath();
      for (const [dx, dy] of [[0, -10], [9, 0], [0, 10], [-9, 0]]) context.lineTo(left + dx, top + dy);
      context.closePath();
      context.stroke();
      context.font = "11px system-ui, sans-serif";
      context.textAlign = "center";
      context.textBaseline = "middle";
      context.fillText(sign(verdict), left, top);
    }
  }

  private leave() {
    this.hovered = null;
    this.tip.hidden = true;
    for (const { pane } of this.facets) pane.style.cursor = "crosshair";
    this.overlay.draw();
  }

  private highlight(context: CanvasRenderingContext2D) {
    this.paintTried(context);
    if (!this.hovered) return;
    const { facet, x, y } = this.hovered;
    context.strokeStyle = colour("ink");
    context.lineWidth = 2;
    context.beginPath();
    context.arc(facet.left + x, facet.top + y, 8, 0, 2 * Math.PI);
    context.stroke();
  }
}
