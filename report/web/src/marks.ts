// Marks of tests: each failure mode has its own shape and colour, so that both can be told apart by either.

import { colour } from "./dom";

/** The colours of Okabe and Ito, "Color Universal Design" (2008), without the blues, which are the colours of tests that pass; and a violet and a brown. */
const MODES = ["#d55e00", "#cc79a7", "#009e73", "#e69f00", "#8f5fd0", "#a0622d"];

export function modeColour(mode: number): string {
  return mode === 0 ? colour("fail") : MODES[(mode - 1) % MODES.length];
}

export function verdictColour(verdict: string): string {
  return colour({ fail: "fail", pass: "pass", unpreventable: "unpreventable", error: "error", invalid: "invalid" }[verdict] ?? "muted");
}

/** The sign of a verdict beside its colour. */
export function sign(verdict: string): string {
  return { fail: "✗", pass: "✓", unpreventable: "▽", inconclusive: "?", invalid: "–", error: "!" }[verdict] ?? "";
}

/** Draws the mark of a failure mode. */
export function mark(context: CanvasRenderingContext2D, mode: number, x: number, y: number, size: number, paint: string) {
  context.strokeStyle = context.fillStyle = paint;
  context.lineWidth = 2;
  context.beginPath();
  const s = size;
  switch ((mode - 1 + 600) % 6) {
    case 1: // a plus
      context.moveTo(x - s, y);
      context.lineTo(x + s, y);
      context.moveTo(x, y - s);
      context.lineTo(x, y + s);
      return context.stroke();
    case 2: // a triangle
      context.moveTo(x, y - s);
      context.lineTo(x + s, y + s);
      context.lineTo(x - s, y + s);
      context.closePath();
      return context.fill();
    case 3: // a diamond
      context.moveTo(x, y - 1.2 * s);
      context.lineTo(x + s, y);
      context.lineTo(x, y + 1.2 * s);
      context.lineTo(x - s, y);
      context.closePath();
      return context.fill();
    case 4: // a square
      return context.fillRect(x - 0.8 * s, y - 0.8 * s, 1.6 * s, 1.6 * s);
    case 5: // a ring
      context.arc(x, y, 0.9 * s, 0, 2 * Math.PI);
      return context.stroke();
    default: // a cross
      context.moveTo(x - s, y - s);
      context.lineTo(x + s, y + s);
      context.moveTo(x - s, y + s);
      context.lineTo(x + s, y - s);
      return context.stroke();
  }
}
