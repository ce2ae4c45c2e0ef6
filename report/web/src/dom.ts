// Makes elements. Texts of a study are always text, never HTML.

type Child = Node | string | number | null | undefined;
type Attributes = Record<string, string | number | boolean | ((event: never) => void) | undefined>;

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value as EventListener);
    else if (typeof value === "boolean") element.toggleAttribute(name, value);
    else if (value !== undefined) element.setAttribute(name, String(value));
  }
  for (const child of children) if (child !== null && child !== undefined) element.append(typeof child === "number" ? String(child) : child);
  return element;
}

/** A canvas that is as sharp as the screen, and that draws itself again when its size or the theme changes. */
export class Sheet {
  readonly canvas: HTMLCanvasElement;
  width = 0;
  height = 0;
  private due = false;

  constructor(private readonly paint: (context: CanvasRenderingContext2D, sheet: Sheet) => void, label: string) {
    this.canvas = h("canvas", { role: "img", "aria-label": label });
    new ResizeObserver(() => this.fit()).observe(this.canvas);
    // A sheet whose canvas is gone is no longer drawn.
    const self = new WeakRef(this);
    onTheme(() => self.deref()?.draw(), self);
  }

  private fit() {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    const scale = devicePixelRatio || 1;
    [this.width, this.height] = [clientWidth, clientHeight];
    this.canvas.width = Math.round(clientWidth * scale);
    this.canvas.height = Math.round(clientHeight * scale);
    this.now();
  }

  /** Draws before the next frame, once however often it is called. */
  draw() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.now();
    });
  }

  private now() {
    const context = this.canvas.getContext("2d");
    if (!context || this.width === 0) return;
    const scale = devicePixelRatio || 1;
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    this.paint(context, this);
  }
}

let listeners: { listener: () => void; of: WeakRef<object> | null }[] = [];

/** Calls a function after each change of the theme, as long as the object is there for which it is called. */
export function onTheme(listener: () => void, of: WeakRef<object> | null = null) {
  listeners = listeners.filter(({ of }) => of === null || of.deref() !== undefined);
  listeners.push({ listener, of });
}

/** Forgets all listeners, because what they draw is gone. */
export function forgetThemes() {
  listeners = [];
}

function announce() {
  colours.clear();
  listeners.forEach(({ listener }) => listener());
}

/** The button that changes between light and dark; at first the page has the theme of the system. */
export function themeButton(): HTMLElement {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const root = document.documentElement;
  const isDark = () => (root.dataset.theme ? root.dataset.theme === "dark" : system.matches);
  const button = h("button", { type: "button", class: "quiet", click: () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    name();
    announce();
  } });
  const name = () => (button.textContent = isDark() ? "Light" : "Dark");
  system.addEventListener("change", () => {
    name();
    announce();
  });
  name();
  return button;
}

const colours = new Map<string, string>();

/** A colour of the present theme. */
export function colour(name: string): string {
  let found = colours.get(name);
  if (found === undefined) {
    found = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
    colours.set(name, found);
  }
  return found;
}
