// The view of a camera in place of the view from above: a film that goes in step with the run.

import { h } from "./dom";
import { filmed, type Wanted } from "./server";
import { reason } from "./words";

/** The greatest difference in seconds between the film and the run while it plays. */
const DRIFT = 0.15;

export class Lens {
  readonly element = h("div", { class: "lens", hidden: true });
  private video: HTMLVideoElement | null = null;
  private leaving = new AbortController();

  /** Asks for the film of a test, and shows it once it is drawn; then calls `ready`. */
  async show(test: Wanted, camera: string, ready: () => void) {
    this.hide();
    const { signal } = this.leaving;
    this.element.hidden = false;
    this.element.replaceChildren(h("p", { class: "note" }, `The film of camera ${camera} is being drawn.`));
    try {
      const film = await filmed(test, camera, signal);
      if (signal.aborted) return;
      const video = h("video", { playsinline: true, src: URL.createObjectURL(film), "aria-label": `The run through camera ${camera}` });
      video.muted = true;
      video.addEventListener("error", () => this.video === video && this.element.replaceChildren(h("p", { class: "note" }, "This browser cannot show H.264 films.")));
      this.video = video;
      this.element.replaceChildren(video);
      ready();
    } catch (error) {
      if (!signal.aborted) this.element.replaceChildren(h("p", { class: "note" }, reason(error)));
    }
  }

  /** Shows the moment of a time. */
  seek(time: number, isPlaying: boolean, speed: number) {
    const { video } = this;
    if (!video) return;
    video.playbackRate = speed;
    const isInside = isPlaying && !(time >= video.duration);
    if (isInside && video.paused) void video.play().catch(() => {});
    else if (!isInside && !video.paused) video.pause();
    if (Math.abs(video.currentTime - time) > (isInside ? DRIFT * Math.max(1, speed) : 0.001)) video.currentTime = time;
  }

  /** Shows the view from above again. */
  hide() {
    this.leaving.abort();
    this.leaving = new AbortController();
    if (this.video) {
      const { src } = this.video;
      // A video that still loads would complain about a film that is gone.
      this.video.removeAttribute("src");
      this.video.load();
      URL.revokeObjectURL(src);
    }
    this.video = null;
    this.element.hidden = true;
    this.element.replaceChildren();
  }
}
