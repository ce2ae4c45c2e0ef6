// Opens a report page in a browser, uses it, and prints what it saw as JSON. Arguments: the folder of playwright-core, the browser, the page, and
// `use` or `look`.
import { createRequire } from "node:module";

const [modules, browserPath, file, task] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/`)("playwright-core");
const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
const seen = { requests: [], errors: [], dialogs: 0 };
page.on("request", (request) => seen.requests.push(request.url()));
page.on("pageerror", (error) => seen.errors.push(error.message));
page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
page.on("dialog", (dialog) => {
  seen.dialogs += 1;
  void dialog.dismiss();
});
await page.goto(`file://${file}`);
await page.waitForSelector("main[data-ready]", { timeout: 30000 });
seen.title = await page.title();
seen.headline = await page.textContent(".headline");
seen.text = await page.evaluate(() => document.body.innerText);
seen.elements = await page.evaluate(() => document.querySelectorAll("main img, main script, main iframe, main b").length);
seen.twice = await page.evaluate(() => {
  const ids = [...document.querySelectorAll("[id]")].map(({ id }) => id);
  return ids.filter((id, at) => ids.indexOf(id) !== at);
});
seen.heights = await page.evaluate(() => [".worst", "#table thead", ".cards .card", "header.top"].map((part) => document.querySelector(part)?.clientHeight ?? 0));
seen.width = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

if (task === "use") {
  // The worst failing test plays at a click, and its contact is on the canvas at the end.
  await page.click(".worst .thumb");
  const world = page.locator("dialog .world canvas");
  await world.waitFor();
  const time = async () => Number(await world.getAttribute("data-time"));
  const begun = await time();
  await page.waitForFunction((from) => Number(document.querySelector("dialog .world canvas").dataset.time) > from + 0.3, begun, { timeout: 10000 });
  seen.plays = true;
  seen.test = await page.textContent("dialog h2");
  await page.keyboard.press("Space");
  seen.paused = await page.locator("#run").getAttribute("data-state");
  await page.locator("dialog input[type=range]").evaluate((scrub) => {
    scrub.value = scrub.max;
    scrub.dispatchEvent(new Event("input"));
  });
  await page.waitForFunction(() => document.querySelector("dialog .world canvas").dataset.contact, undefined, { timeout: 10000 });
  seen.end = await time();
  seen.contact = await world.evaluate((canvas) => {
    const [x, y] = canvas.dataset.contact.split(",").map(Number);
    const scale = devicePixelRatio || 1;
    const { data } = canvas.getContext("2d").getImageData(Math.round((x - 20) * scale), Math.round((y - 20) * scale), 40 * scale, 40 * scale);
    // The ring of the contact is red.
    let red = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 180 && data[i + 1] < 40 && data[i + 2] < 40) red += 1;
    return red;
  });
  seen.plots = await page.locator("dialog .uplot").count();
  seen.run = await page.locator("#run").evaluate(({ dataset }) => [dataset.test, dataset.state]);
  await page.click("#play");
  seen.state = await page.locator("#run").getAttribute("data-state");
  seen.ids = await page.evaluate(() => ["map", "run", "play", "scrub", "x-axis", "y-axis", "table", "parallel"].filter((id) => document.querySelectorAll(`#${id}`).length !== 1));
  // A button that the next test has, too, keeps the focus.
  await page.locator("dialog button[aria-label='Next failing test']").evaluate((button) => {
    button.focus();
    button.click();
  });
  const isNext = (old) => document.querySelector("dialog h2").textContent !== old;
  await page.waitForFunction(isNext, seen.test, { polling: 100 }).catch(async () => {
    const state = await page.evaluate(() => [document.hasFocus(), document.activeElement.outerHTML.slice(0, 200), document.querySelector("dialog h2").textContent]);
    throw new Error(`the next failing test is not shown: ${JSON.stringify([state, seen.errors])}`);
  });
  seen.focus = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  await page.click("dialog header button:last-child");
  // Each failing test has a place on the map.
  seen.spots = await page.locator("#map [data-test]:visible").count();
  const spot = page.locator("#map [data-test]").last();
  seen.spot = await spot.getAttribute("data-test");
  await spot.click();
  await page.waitForSelector("#run");
  seen.bySpot = await page.locator("#run").getAttribute("data-test");
  await page.click("dialog header button:last-child");
  // Other axes give another map.
  const map = page.locator(".canvases canvas").first();
  const picture = () => map.evaluate((canvas) => canvas.toDataURL());
  const before = await picture();
  const options = await page.locator('select[aria-label="Horizontal axis"] option').allTextContents();
  await page.selectOption('select[aria-label="Horizontal axis"]', { index: options.length - 1 });
  await page.waitForTimeout(200);
  seen.changes = (await picture()) !== before;
  await page.selectOption('select[aria-label="Horizontal axis"]', { index: 0 });
  await page.waitForTimeout(200);
  seen.returns = (await picture()) === before;
  // A range on an axis filters the table.
  const count = () => page.textContent(".parallel .count");
  seen.all = await count();
  const axes = page.locator(".parallel > canvas");
  await axes.scrollIntoViewIfNeeded();
  const box = await axes.boundingBox();
  await page.mouse.move(box.x + 48, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + 48, box.y + 140, { steps: 4 });
  await page.mouse.up();
  seen.brushed = await count();
  seen.rows = await page.locator(".scroll tbody tr[data-index]").count();
  await page.click("text=Remove all filters");
  seen.cleared = await count();
  await page.selectOption('select[aria-label="Verdict"]', { label: "fail" });
  seen.failing = await count();
  // Requirements by test: the pointer names a test, and a click plays it.
  await page.click("text=Remove all filters");
  const matrix = page.locator(".strips canvas");
  await matrix.scrollIntoViewIfNeeded();
  const strips = await matrix.boundingBox();
  await page.mouse.move(strips.x + (2.5 / 500) * strips.width, strips.y + 5);
  seen.pointed = await page.textContent(".matrix .note");
  await page.mouse.down();
  await page.mouse.up();
  await page.waitForSelector("dialog[open]");
  seen.byMatrix = await page.textContent("dialog h2");
  await page.click("dialog header button:last-child");
  // The same by keyboard, only among failing tests.
  await page.selectOption('select[aria-label="Verdict"]', { label: "fail" });
  await matrix.focus();
  for (const key of ["PageUp", "ArrowRight", "ArrowRight", "ArrowLeft"]) await page.keyboard.press(key);
  seen.focused = await page.textContent(".matrix .note");
  await page.keyboard.press("Enter");
  await page.waitForSelector("dialog[open]");
  seen.byStripKey = await page.textContent("dialog h2");
  await page.click("dialog header button:last-child");
  await page.click("text=Remove all filters");
  // The table is sorted, and plays a test by keyboard.
  await page.click("th button:has-text('verdict')");
  await page.locator(".scroll").focus();
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await page.waitForSelector("dialog[open]");
  seen.byKeyboard = await page.textContent("dialog h2");
}
console.log(JSON.stringify(seen));
await browser.close();
