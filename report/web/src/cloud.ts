// Draws tests as marks over two parameters: each test as its mark, or as a few pixels if there are many tests.

import { colour } from "./dom";
import { mark, modeColour, sign, verdictColour } from "./marks";
import type { Store } from "./store";

/** With more tests in sight, a test is a few pixels. */
const MOST_MARKS = 5000;

/** A place in pixels for each value: `scale * value + offset`. */
export interface Line {
  scale: number;
  offset: number;
}

export interface Cloud {
  width: number;
  height: number;
  rows: Uint32Array;
  x: Line;
  y: Line;
  /** The positions of both coordinates. */
  axes: [number, number];
  /** True if failing tests have the marks of their failure modes. */
  byMode: boolean;
}

/**
 * Draws the tests of a cloud, and returns true if they are pixels and not marks. Tests that the filters leave out are below all others, and
 * failing tests are above all others.
 */
export function paintTests(context: CanvasRenderingContext2D, store: Store, cloud: Cloud): boolean {
  const { tests, mask, page } = store;
  const { rows, x, y, width, height } = cloud;
  const [cx, cy] = cloud.axes.map((at) => tests.coordinates[at]);
  const fails = page.verdicts.findIndex(({ name }) => name === "fail");
  const layers = [0, 1, 2].map(() => ({ rows: new Uint32Array(rows.length), count: 0 }));
  for (const row of rows) {
    const [px, py] = [x.scale * cx[row] + x.offset, y.scale * cy[row] + y.offset];
    if (px < -5 || px > width + 5 || py < -5 || py > height + 5) continue;
    const layer = layers[mask[row] ? (tests.verdict[row] === fails ? 2 : 1) : 0];
    layer.rows[layer.count++] = row;
  }
  const [faint, others, failing] = layers.map((layer) => layer.rows.subarray(0, layer.count));
  const place = (row: number): [number, number] => [x.scale * cx[row] + x.offset, y.scale * cy[row] + y.offset];
  const verdictOf = (row: number) => verdictColour(page.verdicts[tests.verdict[row]].name);
  const modeOf = (row: number) => (cloud.byMode ? modeColour(tests.mode[row]) : colour("fail"));
  if (faint.length + others.length + failing.length > MOST_MARKS) {
    const pixels = new Pixels(width, height);
    // Dots that would cover the map are smaller.
    const size = 4 * (others.length + failing.length) > 0.4 * width * height ? 1 : 2;
    for (const row of faint) pixels.dot(place(row), size, colour("faint"));
    for (const row of others) pixels.dot(place(row), size, verdictOf(row));
    for (const row of failing) pixels.dot(place(row), size + 1, modeOf(row));
    pixels.paint(context);
    return true;
  }
  context.fillStyle = colour("faint");
  for (const row of faint) {
    const [px, py] = place(row);
    context.fillRect(px - 1, py - 1, 2, 2);
  }
  context.font = "bold 11px system-ui, sans-serif";
  [context.textAlign, context.textBaseline] = ["center", "middle"];
  for (const row of others) {
    const [px, py] = place(row);
    const verdict = page.verdicts[tests.verdict[row]].name;
    context.fillStyle = verdictOf(row);
    // A test that passes is a dot, and each other verdict has its sign.
    if (verdict === "pass") context.fillRect(px - 2, py - 2, 4, 4);
    else context.fillText(sign(verdict), px, py);
  }
  for (const row of failing) mark(context, cloud.byMode ? tests.mode[row] : 1, ...place(row), 4, modeOf(row));
  return false;
}

const packed = new Map<string, number>();

/** A colour as the four bytes of a pixel. */
function pixel(name: string): number {
  let number = packed.get(name);
  if (number === undefined) {
    const context = new OffscreenCanvas(1, 1).getContext("2d")!;
    context.fillStyle = name;
    context.fillRect(0, 0, 1, 1);
    number = new Uint32Array(context.getImageData(0, 0, 1, 1).data.buffer)[0];
    packed.set(name, number);
  }
  return number;
}

/** A picture in which dots are written as pixels: many times faster than shapes on a canvas. */
class Pixels {
  private readonly ratio = devicePixelRatio || 1;
  private readonly image: ImageData;
  private readonly numbers: Uint32Array;

  constructor(private readonly width: number, private readonly height: number) {
    this.image = new ImageData(Math.max(1, Math.round(width * this.ratio)), Math.max(1, Math.round(height * this.ratio)));
    this.numbers = new Uint32Array(this.image.data.buffer);
  }

  dot([px, py]: [number, number], size: number, name: string) {
    const { image, numbers, ratio } = this;
    const side = Math.round(size * ratio);
    const number = pixel(name);
    const [x0, y0] = [Math.round(px * ratio - side / 2), Math.round(py * ratio - side / 2)];
    for (let y = Math.max(0, y0); y < Math.min(image.height, y0 + side); y++) {
      numbers.fill(number, y * image.width + Math.max(0, x0), y * image.width + Math.max(0, Math.min(image.width, x0 + side)));
    }
  }

  paint(context: CanvasRenderingContext2D) {
    const canvas = new OffscreenCanvas(this.image.width, this.image.height);
    canvas.getContext("2d")!.putImageData(this.image, 0, 0);
    context.drawImage(canvas, 0, 0, this.width, this.height);
  }
}
