// Plays a run from above: roads, bodies with their headings, and the contact at the end.

import type { Played, Run } from "./data";
import { colour, Sheet } from "./dom";

/** The height of the view in metres while it follows the car. */
const VIEW = 46;

const BODIES: Record<string, string> = {
  car: "#56b4e9", van: "#0072b2", truck: "#0072b2", bus: "#0072b2", motorcycle: "#b8a800", bicycle: "#b8a800",
  pedestrian: "#cc79a7", building: "#c2ae90", tree: "#009e73", sign: "#bbbbbb", prop: "#9a9a9a",
};
/** The colour of the car under test. */
const UNDER_TEST = "#d55e00";

interface Pose {
  x: number;
  y: number;
  heading: number;
}

/** A body with its poses as numbers. */
interface Body {
  played: Played;
  poses: Pose[];
}

export class Motion {
  readonly bodies: Body[];
  readonly duration: number;

  constructor(readonly run: Run) {
    this.bodies = run.bodies.map((played) => ({ played, poses: unrolled(played.poses) }));
    this.duration = run.times[run.times.length - 1] ?? 0;
  }

  /** The pose of a body at a time, between two moments in a straight line; null while it is not in the world. */
  at(body: Body, time: number): Pose | null {
    const { times } = this.run;
    const [first, end] = body.played.there;
    if (body.poses.length === 1 && end > first) return time >= times[first] - 1e-9 && (end === times.length || time < times[end]) ? body.poses[0] : null;
    const place = this.place(time);
    const low = Math.floor(place);
    if (low < first || low >= end) return null;
    const a = body.poses[low - first];
    const b = body.poses[Math.min(low + 1, end - 1) - first];
    const share = place - low;
    const turn = Math.atan2(Math.sin(b.heading - a.heading), Math.cos(b.heading - a.heading));
    return { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y), heading: a.heading + share * turn };
  }

  /** The place of a time among the moments; a whole number at a moment. */
  place(time: number): number {
    const { times } = this.run;
    let [low, high] = [0, times.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    const next = times[low + 1];
    return next === undefined ? low : low + Math.min(1, Math.max(0, (time - times[low]) / (next - times[low])));
  }

  /** The point at which the car touches the other body at the end. */
  contact(): { x: number; y: number } | null {
    const { touched } = this.run;
    if (touched === null) return null;
    const [car, other] = [this.bodies[0], this.bodies[touched]].map((body) => body.poses[body.poses.length - 1]);
    const { length, width } = this.run.bodies[0];
    const [cos, sin] = [Math.cos(car.heading), Math.sin(car.heading)];
    const [dx, dy] = [other.x - car.x, other.y - car.y];
    const clamp = (value: number, most: number) => Math.min(most, Math.max(-most, value));
    const [ahead, aside] = [clamp(cos * dx + sin * dy, length / 2), clamp(cos * dy - sin * dx, width / 2)];
    return { x: car.x + cos * ahead - sin * aside, y: car.y + sin * ahead + cos * aside };
  }
}

function unrolled(numbers: number[]): Pose[] {
  const poses: Pose[] = [];
  let [x, y, heading] = [0, 0, 0];
  for (let i = 0; i + 2 < numbers.length; i += 3) {
    x += numbers[i];
    y += numbers[i + 1];
    heading += numbers[i + 2];
    poses.push({ x: x / 100, y: y / 100, heading: heading / 1000 });
  }
  return poses;
}

export class Player {
  readonly sheet: Sheet;
  time = 0;
  follows = true;
  private readonly grounds: { surface: string; path: Path2D }[];

  constructor(readonly motion: Motion, label: string) {
    this.grounds = motion.run.roads.map(({ surface, polygons }) => {
      const path = new Path2D();
      for (const polygon of polygons) {
        let [x, y] = [0, 0];
        for (let i = 0; i + 1 < polygon.length; i += 2) {
          x += polygon[i];
          y += polygon[i + 1];
          if (i === 0) path.moveTo(x / 100, y / 100);
          else path.lineTo(x / 100, y / 100);
        }
        path.closePath();
      }
      return { surface, path };
    });
    this.sheet = new Sheet((context, { width, height }) => this.paint(context, width, height), label);
  }

  seek(time: number) {
    this.time = Math.min(this.motion.duration, Math.max(0, time));
    this.sheet.draw();
  }

  get isAtEnd(): boolean {
    return this.time >= this.motion.duration - 1e-6;
  }

  private view(width: number, height: number): { scale: number; x: number; y: number } {
    const car = this.motion.at(this.motion.bodies[0], this.time) ?? this.motion.bodies[0].poses[0];
    if (this.follows) return { scale: height / VIEW, x: car.x + (0.12 * width * VIEW) / height, y: car.y };
    const { poses } = this.motion.bodies[0];
    const [xs, ys] = [poses.map((pose) => pose.x), poses.map((pose) => pose.y)];
    const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = Math.min(width / (x1 - x0 + 40), height / (y1 - y0 + 40));
    return { scale, x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
  }

  private paint(context: CanvasRenderingContext2D, width: number, height: number) {
    const { scale, x, y } = this.view(width, height);
    const { motion, time } = this;
    const { canvas } = context;
    context.fillStyle = colour("ground");
    context.fillRect(0, 0, width, height);
    context.save();
    context.translate(width / 2, height / 2);
    context.scale(scale, -scale);
    context.translate(-x, -y);
    for (const { surface, path } of this.grounds) {
      context.fillStyle = colour(surface === "line" ? "mark" : surface);
      context.fill(path);
    }
    // The way that the car has taken.
    context.strokeStyle = UNDER_TEST;
    context.globalAlpha = 0.5;
    context.lineWidth = Math.max(0.15, 1.5 / scale);
    context.beginPath();
    const until = Math.floor(motion.place(time));
    motion.bodies[0].poses.slice(0, until + 1).forEach((pose, i) => (i === 0 ? context.moveTo(pose.x, pose.y) : context.lineTo(pose.x, pose.y)));
    context.stroke();
    context.globalAlpha = 1;
    [...motion.bodies].reverse().forEach((body) => {
      const pose = motion.at(body, time);
      if (pose) paintBody(context, body.played, pose, body === motion.bodies[0], scale);
    });
    const contact = this.isAtEnd ? motion.contact() : null;
    delete canvas.dataset.contact;
    if (contact) {
      const r = Math.max(0.8, 12 / scale);
      context.strokeStyle = colour("contact");
      context.lineWidth = Math.max(0.2, 3 / scale);
      context.beginPath();
      context.arc(contact.x, contact.y, r, 0, 2 * Math.PI);
      context.stroke();
      canvas.dataset.contact = `${(width / 2 + scale * (contact.x - x)).toFixed(1)},${(height / 2 - scale * (contact.y - y)).toFixed(1)}`;
    }
    context.restore();
    canvas.dataset.time = time.toFixed(2);
    paintScale(context, scale, height);
  }
}

function paintBody(context: CanvasRenderingContext2D, body: Played, pose: Pose, isEgo: boolean, scale: number) {
  context.save();
  context.translate(pose.x, pose.y);
  context.rotate(pose.heading);
  context.fillStyle = isEgo ? UNDER_TEST : (BODIES[body.class] ?? BODIES.prop);
  context.strokeStyle = colour("rim");
  context.lineWidth = 1.2 / scale;
  context.beginPath();
  if (body.round || body.class === "tree") {
    const radius = Math.max(body.class === "tree" ? 0.25 * body.height : body.length / 2, 3.5 / scale);
    context.arc(0, 0, radius, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    if (body.class === "pedestrian") {
      context.beginPath();
      context.moveTo(0, 0);
      context.lineTo(radius * 1.8, 0);
      context.stroke();
    }
  } else {
    const [l, w] = [body.length / 2, Math.max(body.width / 2, 2.5 / scale)];
    context.rect(-l, -w, 2 * l, 2 * w);
    context.fill();
    context.stroke();
    if (!["building", "sign", "prop"].includes(body.class)) {
      // The windscreen shows where the front is.
      context.fillStyle = "rgba(255, 255, 255, 0.75)";
      context.fillRect(0.2 * l, -0.75 * w, 0.35 * l, 1.5 * w);
    }
  }
  context.restore();
}

function paintScale(context: CanvasRenderingContext2D, scale: number, height: number) {
  const metres = [1, 2, 5, 10, 20, 50, 100, 200, 500].find((length) => length * scale >= 60) ?? 1000;
  const length = metres * scale;
  context.fillStyle = colour("halo");
  context.fillRect(8, height - 28, length + 16, 22);
  context.fillStyle = colour("ink");
  context.fillRect(16, height - 12, length, 2);
  context.font = "11px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "bottom";
  context.fillText(`${metres} m`, 16, height - 13);
}
