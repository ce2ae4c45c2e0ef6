// The dialog in which a run is played, with its signals and the bounds of its robustness.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Run } from "./data";
import { colour, h } from "./dom";
import { Inquiries } from "./inquiries";
import { Lens } from "./lens";
import { sign } from "./marks";
import { Motion, Player } from "./player";
import { cameras, type Ran, ran as runOf, type Wanted } from "./server";
import { Sliders } from "./sliders";
import type { Store } from "./store";
import { reason, withUnit } from "./words";

const SPEEDS = [0.25, 0.5, 1, 2, 4];
/** The height of a plot in pixels: four plots fit beside the run on a small screen. */
const HEIGHT = 100;
/** The signals that are drawn first, if a run has them. */
const FIRST = ["car.speed", "car.clearance"];

export class Film {
  readonly dialog = h("dialog", { class: "film", "aria-label": "A test" });
  private readonly stage = h("div", { class: "stage" });
  private readonly outcome = h("div", { class: "outcome" });
  private stop: () => void = () => {};
  /** The time of the run that is shown, and whether it plays. */
  private state = () => ({ time: 0, isPlaying: true });
  /** The number of the newest question: older answers are not shown. */
  private asked = 0;
  /** The signals that are drawn. */
  private readonly signals = new Set(FIRST);
  /** The newest test that should run, while another one runs. */
  private waiting: [number[], boolean] | null = null;
  private isRunning = false;
  /** The number of tests whose runs are asked for. */
  private pending = 0;
  private readonly inquiries: Inquiries;
  /** How runs are shown: the speed, and whether the view follows the car. */
  private speed = 1;
  private follows = true;
  /** The names of the cameras that film tests, once somebody has asked for them. */
  private cameras: Promise<string[]> | null = null;

  constructor(private readonly store: () => Store) {
    this.inquiries = new Inquiries(store);
    // The event of a closed dialog may come after the next test was asked for, so that it forgets nothing.
    this.dialog.addEventListener("cancel", () => this.leave());
    this.dialog.addEventListener("close", () => {
      if (!this.dialog.open) this.stop();
    });
    this.dialog.addEventListener("click", (event) => {
      if (event.target === this.dialog) this.close();
    });
  }

  /** Forgets the test that is shown, and the questions about it. */
  private leave() {
    this.asked += 1;
    this.waiting = null;
    this.stop();
    this.inquiries.clear();
  }

  private close() {
    this.leave();
    this.dialog.close();
  }

  /** True while the dialog is open, or about to open. */
  get isBusy(): boolean {
    return this.dialog.open || this.pending > 0;
  }

  /** Opens the dialog for a test, and plays its run if there is one. */
  async show(index: number) {
    const asked = ++this.asked;
    this.waiting = null;
    this.pending += 1;
    const store = this.store();
    const row = store.rowOf(index);
    let [run, why]: [Run | null, string] = [null, this.without(index)];
    let differs: string | null = null;
    try {
      ({ run, differs } = await store.run(index));
    } catch (error) {
      why = reason(error);
    }
    this.pending -= 1;
    if (this.asked !== asked) return;
    this.stop();
    const focused = this.dialog.contains(document.activeElement) ? document.activeElement?.getAttribute("aria-label") : null;
    this.stage.replaceChildren(h("p", { class: "note" }, why));
    this.dialog.replaceChildren(this.head(index, row), this.stage, this.about(index, row));
    if (differs) this.stage.before(h("p", { class: "differs", role: "alert" }, differs));
    this.inquiries.about(index, row < 0 ? "" : store.verdictName(row));
    this.dialog.append(this.inquiries.element);
    if (store.page.served && row >= 0) this.dialog.append(this.change(store.numbersOf(row)));
    if (!this.dialog.open) this.dialog.showModal();
    if (focused) [...this.dialog.querySelectorAll("button")].find((button) => button.getAttribute("aria-label") === focused)?.focus();
    if (run) this.play(run, `Test ${index}`, index);
    if (!focused) this.focusPlay();
  }

  /** Opens the dialog for a new test, runs it and plays its run. */
  async attempt(numbers: number[]) {
    this.asked += 1;
    this.waiting = null;
    this.stop();
    this.stage.replaceChildren(h("p", { class: "note" }, "The test runs."));
    this.inquiries.clear();
    this.dialog.replaceChildren(this.newHead(""), this.stage, this.inquiries.element, this.change(numbers));
    if (!this.dialog.open) this.dialog.showModal();
    await this.run(numbers, true);
  }

  /** The part of the dialog that changes the test. */
  private change(numbers: number[]): HTMLElement {
    const { page } = this.store();
    this.outcome.replaceChildren();
    const sliders = new Sliders(page.coordinates, numbers, (changed, isDone) => void this.run(changed, isDone));
    return h("details", { class: "change", open: true }, h("summary", {}, "Change the test: drag a value, and the test runs with it"), sliders.element, this.outcome);
  }

  /** Runs a new test. While it runs, only the newest wish waits. */
  private async run(numbers: number[], isDone: boolean) {
    this.waiting = [numbers, isDone];
    if (this.isRunning) return;
    this.isRunning = true;
    while (this.waiting) {
      const [wanted, isLast]: [number[], boolean] = this.waiting;
      this.waiting = null;
      const asked = ++this.asked;
      let ran: Ran | null = null;
      let why = "A system has no world to show.";
      try {
        ran = await runOf(wanted);
        why = ran.problem ?? why;
      } catch (error) {
        why = reason(error);
      }
      if (this.asked !== asked || !this.dialog.open) continue;
      this.showNew(wanted, ran, why);
      if (ran && isLast) this.store().add(wanted, ran.verdict);
    }
    this.isRunning = false;
  }

  private showNew(wanted: number[], ran: Ran | null, why: string) {
    const { time, isPlaying } = this.state();
    this.stop();
    this.dialog.querySelector(":scope > .about")?.remove();
    this.dialog.firstElementChild?.replaceWith(this.newHead(ran?.verdict ?? ""));
    this.inquiries.about(wanted, ran?.verdict ?? "");
    const units = new Map(this.store().page.requirements.map(({ id, unit }) => [id, unit]));
    const margins = Object.entries(ran?.robustness ?? {}).map(([id, value]) => `${id}: robustness ${value === null ? "undecided" : withUnit(value, units.get(id) ?? null)}`);
    this.outcome.replaceChildren(...(ran ? [
      h("p", {}, margins.join("; ")),
      h("p", { class: "muted" }, "This test is no test of the campaign. Its values: ", h("code", { class: "values" }, JSON.stringify(ran.test)), ", its trace hash: ", h("code", { class: "hash" }, ran.trace_hash ?? "none")),
    ] : []));
    this.stage.replaceChildren(h("p", { class: "note" }, why));
    if (ran?.run) {
      this.play(ran.run, "A new test", wanted, time, isPlaying);
      if (!this.dialog.querySelector(".change")?.contains(document.activeElement)) this.focusPlay();
      const canvas = this.stage.querySelector<HTMLElement>("#run");
      if (canvas) Object.assign(canvas.dataset, { verdict: ran.verdict, traceHash: ran.trace_hash ?? "none" });
    }
  }

  /** The space bar plays and pauses from the beginning. */
  private focusPlay() {
    this.stage.querySelector<HTMLElement>("#play")?.focus();
  }

  private newHead(verdict: string): HTMLElement {
    return h("header", {},
      h("h2", {}, "A new test", verdict ? ": " : "", h("span", { class: `verdict ${verdict}` }, `${sign(verdict)} ${verdict}`)),
      h("button", { type: "button", class: "quiet", "aria-label": "Close", click: () => this.close() }, "Close"),
    );
  }

  private head(index: number, row: number): HTMLElement {
    const store = this.store();
    const verdict = row < 0 ? "" : store.verdictName(row);
    const steps = [[-1, "Previous failing test"], [1, "Next failing test"]] as const;
    return h("header", {},
      h("h2", {}, `Test ${index}: `, h("span", { class: `verdict ${verdict}` }, `${sign(verdict)} ${verdict}`)),
      ...steps.map(([by, label]) => h("button", { type: "button", class: "quiet", "aria-label": label, title: label, click: () => this.step(index, by) }, by < 0 ? "◀ failing" : "failing ▶")),
      h("button", { type: "button", class: "quiet", "aria-label": "Close", click: () => this.close() }, "Close"),
    );
  }

  /** Goes to the next failing test with a run, in the order of the tests. */
  private step(index: number, by: number) {
    const store = this.store();
    const fails = store.page.verdicts.findIndex(({ name }) => name === "fail");
    for (let row = store.rowOf(index) + by; row >= 0 && row < store.tests.rows; row += by) {
      if (store.tests.verdict[row] === fails && store.mask[row]) return void this.show(store.tests.index[row]);
    }
  }

  private without(index: number): string {
    const { runs, study } = this.store().page;
    const why = runs.why ? ` (${runs.why})` : "";
    // A system has no world to draw.
    const command = study.scenario === null ? "" : ` This command draws it: ${study.program} replay ${study.folder} ${index} --draw test-${index}.gif${study.trusting}`;
    const which = study.scenario === null ? "" : " It has the runs of failing tests and of a sample of the others.";
    return `This page does not have the run of test ${index}${why}.${which}${command}`;
  }

  private play(run: Run, name: string, test: Wanted, begin = 0, isToPlay = true) {
    const motion = new Motion(run);
    const player = new Player(motion, `${name} from above`);
    const clock = h("output", { class: "clock" });
    const scrub = h("input", { id: "scrub", type: "range", min: 0, max: motion.duration, step: 0.01, value: 0, "aria-label": "Time", input: () => seek(Number(scrub.value)) });
    const button = h("button", { id: "play", type: "button", class: "play", click: () => (isPlaying ? pause() : start()) });
    const { canvas } = player.sheet;
    canvas.id = "run";
    canvas.dataset.test = typeof test === "number" ? String(test) : "new";
    player.follows = this.follows;
    const speeds = h("select", { "aria-label": "Speed", change: () => (this.speed = Number(speeds.value)) }, ...SPEEDS.map((factor) => h("option", { value: factor, selected: factor === this.speed }, `${factor}×`)));
    const lens = new Lens();
    const view = h("select", { "aria-label": "View", change: () => {
      const camera = view.selectedOptions[0]?.dataset.camera;
      canvas.hidden = camera !== undefined;
      if (camera !== undefined) return void lens.show(test, camera, () => seek(player.time));
      lens.hide();
      player.follows = this.follows = view.value === "car";
      player.sheet.draw();
    } }, h("option", { value: "car", selected: this.follows }, "follow the car"), h("option", { value: "all", selected: !this.follows }, "whole way"));
    if (this.store().page.served) this.cameras ??= cameras();
    this.cameras?.then(
      (names) => view.append(...names.map((name) => h("option", { "data-camera": name }, `camera ${name}`))),
      (error: unknown) => {
        // The next run asks again.
        this.cameras = null;
        view.append(h("option", { disabled: true }, `no camera: ${reason(error)}`));
      },
    );
    const plots = this.plots(run, (time) => {
      pause();
      seek(time);
    });
    let [isPlaying, last, frame] = [false, 0, 0];
    const state = () => (canvas.dataset.state = isPlaying ? "playing" : player.isAtEnd ? "ended" : "paused");
    const seek = (time: number) => {
      player.seek(time);
      state();
      scrub.value = String(player.time);
      clock.textContent = `${player.time.toFixed(2)} of ${motion.duration.toFixed(2)} s`;
      plots.cursor(player.time);
      lens.seek(player.time, isPlaying, this.speed);
    };
    const tick = (now: number) => {
      if (!isPlaying) return;
      seek(player.time + (this.speed * (now - last)) / 1000);
      last = now;
      if (player.isAtEnd) pause();
      else frame = requestAnimationFrame(tick);
    };
    const start = () => {
      if (player.isAtEnd) seek(0);
      [isPlaying, last] = [true, performance.now()];
      tell();
      frame = requestAnimationFrame(tick);
    };
    const pause = () => {
      isPlaying = false;
      cancelAnimationFrame(frame);
      lens.seek(player.time, isPlaying, this.speed);
      tell();
    };
    const tell = () => {
      button.textContent = isPlaying ? "Pause" : "Play";
      this.dialog.dataset.playing = String(isPlaying);
      state();
    };
    const keys = (event: KeyboardEvent) => {
      if (event.target instanceof Element && event.target.closest("select, input, summary")) return;
      if (event.key === " " && event.target instanceof HTMLButtonElement) return;
      if (event.key === " ") isPlaying ? pause() : start();
      else if (event.key === "ArrowLeft" || event.key === "ArrowRight") seek(player.time + (event.key === "ArrowLeft" ? -0.1 : 0.1));
      else return;
      event.preventDefault();
    };
    this.dialog.addEventListener("keydown", keys);
    this.state = () => ({ time: player.time, isPlaying });
    this.stop = () => {
      pause();
      this.dialog.removeEventListener("keydown", keys);
      plots.destroy();
      lens.hide();
      this.state = () => ({ time: 0, isPlaying: true });
      this.stop = () => {};
    };
    this.stage.replaceChildren(
      h("div", { class: "world" }, player.sheet.canvas, lens.element, h("div", { class: "controls" }, button, scrub, clock, speeds, view)),
      plots.element,
    );
    seek(begin);
    if (isToPlay) start();
    else pause();
  }

  /** The plots of a run: the bounds of the robustness of each requirement, and signals. */
  private plots(run: Run, seek: (time: number) => void) {
    const all: uPlot[] = [];
    const element = h("div", { class: "plots" });
    const units = new Map(this.store().page.requirements.map(({ id, unit }) => [id, unit]));
    const plot = (title: string, series: { label: string; values: (number | null)[]; stroke: string | (() => string); dash?: number[] }[], zero: boolean) => {
      const place = h("div", {});
      const made = new uPlot({
        width: 400, height: HEIGHT, title,
        legend: { show: false },
        cursor: { y: false, drag: { x: false, y: false } },
        scales: { x: { time: false } },
        axes: [
          { stroke: () => colour("muted"), grid: { stroke: () => colour("grid"), width: 1 }, size: 24, font: "10px system-ui" },
          { stroke: () => colour("muted"), grid: { stroke: () => colour("grid"), width: 1 }, size: 46, font: "10px system-ui" },
        ],
        series: [{}, ...series.map(({ label, stroke, dash }) => ({ label, stroke, dash, width: 1.5, points: { show: false } }))],
        hooks: zero ? { draw: [(u: uPlot) => zeroLine(u)] } : {},
      }, [run.times, ...series.map(({ values }) => values)] as uPlot.AlignedData, place);
      made.over.addEventListener("click", () => {
        if (made.cursor.left !== undefined && made.cursor.left !== null && made.cursor.left >= 0) seek(made.posToVal(made.cursor.left, "x"));
      });
      all.push(made);
      element.append(place);
      new ResizeObserver(() => place.clientWidth > 0 && made.setSize({ width: place.clientWidth, height: HEIGHT })).observe(place);
      return { made, place };
    };
    for (const { id, lower, upper, end } of run.robustness) {
      plot(`robustness of ${id}: ${end === null ? "undecided" : `${withUnit(end, units.get(id) ?? null)} at the end`}`, [
        { label: "at most", values: upper, stroke: () => colour("pass") },
        { label: "at least", values: lower, stroke: () => colour("pass"), dash: [4, 4] },
      ], true);
    }
    const shown = new Map<string, { made: uPlot; place: HTMLElement }>();
    const toggle = (name: string, on: boolean) => {
      const signal = run.signals.find((signal) => signal.name === name);
      if (on && signal) shown.set(name, plot(signal.unit ? `${name} (${signal.unit})` : name, [{ label: name, values: signal.values, stroke: "#d55e00" }], false));
      else if (!on) {
        const old = shown.get(name);
        if (!old) return;
        all.splice(all.indexOf(old.made), 1);
        old.made.destroy();
        old.place.remove();
        shown.delete(name);
      }
    };
    this.signals.forEach((name) => toggle(name, true));
    const more = h("details", {}, h("summary", {}, "Signals"), h("div", { class: "choices" }, ...run.signals.map(({ name }) =>
      h("label", {}, h("input", { type: "checkbox", checked: this.signals.has(name), change: (event: Event) => {
        const { checked } = event.target as HTMLInputElement;
        if (checked) this.signals.add(name);
        else this.signals.delete(name);
        toggle(name, checked);
      } }), ` ${name}`))));
    return {
      element: h("div", { class: "beside" }, element, more),
      cursor: (time: number) => all.forEach((made) => made.setCursor({ left: made.valToPos(time, "x"), top: -10 }, false)),
      destroy: () => all.forEach((made) => made.destroy()),
    };
  }

  private about(index: number, row: number): HTMLElement {
    const store = this.store();
    const { page, tests } = store;
    const unit = (id: string) => page.requirements.find((requirement) => requirement.id === id)?.unit ?? null;
    if (row < 0) return h("p", { class: "note" }, "The table of this page does not have this test.");
    const mode = tests.mode[row];
    return h("div", { class: "about" },
      h("dl", {}, ...store.valuesOf(row).flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]),
        ...tests.robustness.flatMap(({ id, values }) => [h("dt", {}, `robustness of ${id}`), h("dd", {}, Number.isNaN(values[row]) ? "undecided" : withUnit(values[row], unit(id)))])),
      mode ? h("p", {}, page.modes.modes[mode - 1].words) : null,
      h("p", { class: "command" }, h("code", {}, `${page.study.program} replay ${page.study.folder} ${index}${page.study.trusting}`)),
    );
  }
}

function zeroLine(u: uPlot) {
  const y = u.valToPos(0, "y", true);
  if (y < u.bbox.top || y > u.bbox.top + u.bbox.height) return;
  u.ctx.save();
  u.ctx.strokeStyle = colour("fail");
  u.ctx.lineWidth = devicePixelRatio;
  u.ctx.beginPath();
  u.ctx.moveTo(u.bbox.left, y);
  u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
  u.ctx.stroke();
  u.ctx.restore();
}
