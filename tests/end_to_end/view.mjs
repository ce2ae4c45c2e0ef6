// Opens the page of a viewer in a browser, uses it, and prints what it saw as JSON. Arguments: the folder of playwright-core, the browser, the
// address, and `use`, `maps` or `follow`.
import { createRequire } from "node:module";

const [modules, browserPath, address, task] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/`)("playwright-core");
const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
const seen = { foreign: 0, errors: [] };
page.on("request", (request) => (seen.foreign += [address, "blob:"].some((start) => request.url().startsWith(start)) ? 0 : 1));
page.on("pageerror", (error) => seen.errors.push(error.message));
page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
await page.goto(address);
await page.waitForSelector("main[data-ready]", { timeout: 30000 });
seen.headline = await page.textContent(".headline");

/** The outcome of the new test that the dialog shows, once it is another one than before. It is read at one moment: a slider that is dragged runs many tests. */
async function outcome(before) {
  const shown = await page.waitForFunction((old) => {
    const [verdict, values, hash] = ["h2", ".values", ".hash"].map((part) => document.querySelector(`dialog ${part}`)?.textContent);
    return (values ?? old) !== old && { verdict, values, hash };
  }, before, { timeout: 20000 });
  return shown.jsonValue();
}

/** Clicks an empty place of the map. */
async function clickNowhere() {
  const pane = await page.locator(".pane").first().boundingBox();
  for (let i = 1; i < 24; i++) {
    for (let j = 1; j < 24; j++) {
      const place = [pane.x + (pane.width * i) / 24, pane.y + (pane.height * j) / 24];
      await page.mouse.move(...place);
      if (await page.locator(".tip").isHidden()) return page.mouse.click(...place);
    }
  }
}

/** Turns the wheel over the middle of the map. */
async function wheel(by) {
  const pane = await page.locator(".pane").first().boundingBox();
  await page.mouse.move(pane.x + pane.width / 2, pane.y + pane.height / 2);
  await page.mouse.wheel(0, by);
  await page.waitForTimeout(300);
}

if (task === "use") {
  // A place far from every test, and a click on it.
  await clickNowhere();
  seen.clicked = await outcome("");
  await page.waitForSelector("#run");
  seen.run = await page.locator("#run").evaluate(({ dataset: { test, verdict, traceHash } }) => [test, verdict, traceHash]);
  await page.waitForSelector("dialog .world canvas[data-time]");
  const time = () => page.locator("dialog .world canvas").getAttribute("data-time").then(Number);
  await page.waitForFunction(() => Number(document.querySelector("dialog .world canvas").dataset.time) > 0.2, undefined, { timeout: 10000 });
  seen.plays = (await time()) > 0.2;
  // A value is dragged, and the test runs with it.
  const slider = await page.locator("dialog .sliders input").first().boundingBox();
  await page.mouse.move(slider.x + slider.width / 2, slider.y + slider.height / 2);
  await page.mouse.down();
  await page.mouse.move(slider.x + slider.width * 0.8, slider.y + slider.height / 2, { steps: 5 });
  await page.mouse.up();
  seen.dragged = await outcome(seen.clicked.values);
  await page.click("dialog header button:last-child");
  // The buttons of a failing test.
  await page.click(".worst .thumb");
  await page.waitForSelector("dialog[open] .about");
  await page.click("dialog .inquiries >> text=Blame");
  await page.waitForSelector(".answer th");
  seen.blame = await page.textContent(".answer p");
  await page.locator("dialog .inquiries >> text=Shrink").focus();
  await page.keyboard.press("Space");
  await page.waitForSelector(".answer button");
  seen.shrunk = await page.textContent(".answer p");
  // A film, which is in step with the run.
  const views = page.locator("dialog select[aria-label=View]");
  await page.waitForFunction(() => document.querySelector("dialog select[aria-label=View]").options.length > 2, undefined, { timeout: 20000 });
  await views.selectOption({ label: "camera front" });
  await page.waitForFunction(() => document.querySelector(".lens video")?.readyState >= 2 || /adapter/.test(document.querySelector(".lens .note")?.textContent), undefined, { timeout: 60000 });
  await page.evaluate(() => document.querySelector("dialog").dataset.playing === "true" && document.querySelector("dialog .play").click());
  await page.locator("dialog input[aria-label=Time]").evaluate((scrub) => {
    scrub.value = "2.5";
    scrub.dispatchEvent(new Event("input"));
  });
  seen.film = await page.evaluate(() => {
    const video = document.querySelector(".lens video");
    return video && [video.videoWidth, video.videoHeight, Math.round(10 * Math.abs(video.currentTime - parseFloat(document.querySelector(".clock").textContent)))];
  });
  await views.selectOption({ label: "whole way" });
  seen.above = await page.isVisible("dialog .world canvas");
  await page.click(".answer button");
  seen.simplest = await outcome("");
  await page.click("dialog header button:last-child");
  // Any test of the table is played: the last one, too.
  await page.locator(".scroll").focus();
  await page.keyboard.press("End");
  await page.keyboard.press("Enter");
  await page.waitForSelector("dialog[open] .world canvas[data-time]");
  seen.row = await page.textContent("dialog h2");
  await page.click("dialog header button:last-child");
  // A new test by keyboard alone.
  await page.locator("text=New test").first().focus();
  await page.keyboard.press("Enter");
  await page.waitForSelector("dialog[open] .values");
  seen.middle = await page.textContent("dialog .values");
  await page.click("dialog header button:last-child");
  // On a part of the map, a click is a test of this part with as many digits as the part needs.
  for (let i = 0; i < 8; i++) await wheel(-600);
  await clickNowhere();
  seen.zoomed = (await outcome(seen.middle)).values;
} else if (task === "maps") {
  // The page has one map, and asks for the others.
  const shade = () => page.waitForFunction(() => document.querySelector("#map .note").textContent.includes("Shade"), undefined, { timeout: 30000 }).then(() => true);
  seen.shaded = [await shade()];
  const shown = await page.locator("#x-axis, #y-axis").evaluateAll((axes) => axes.map(({ value }) => value));
  const other = ["0", "1", "2", "3"].find((at) => !shown.includes(at));
  await page.selectOption("#y-axis", other);
  seen.shaded.push(await shade());
} else {
  const tests = async () => Number((await page.textContent(".headline")).replaceAll(",", "").match(/(\d+) tests/)?.[1]);
  seen.counts = [await tests()];
  while (seen.counts.length < 2) {
    const last = seen.counts.at(-1);
    await page.waitForFunction((count) => Number(document.querySelector(".headline")?.textContent.replaceAll(",", "").match(/(\d+) tests/)?.[1]) > count, last, { timeout: 60000 });
    seen.counts.push(await tests());
  }
  // While a part of the map is shown, the page only tells of new tests.
  const told = () => page.waitForSelector(".unfinished button", { state: "attached", timeout: 60000 });
  // The page may be made again while the wheel turns.
  for (let i = 0; i < 20 && (await page.locator(".unfinished button").count()) === 0; i++) {
    await wheel(-600);
    await page.waitForTimeout(1000);
  }
  await told();
  const shown = await tests();
  const news = await page.textContent(".unfinished");
  await page.waitForFunction((old) => document.querySelector(".unfinished").textContent !== old, news, { timeout: 60000 });
  seen.isKept = (await tests()) === shown;
  await page.click(".unfinished button");
  await page.waitForFunction((count) => Number(document.querySelector(".headline")?.textContent.replaceAll(",", "").match(/(\d+) tests/)?.[1]) > count, shown, { timeout: 60000 });
  // While a test is shown, too.
  await page.waitForSelector(".worst .thumb canvas");
  // The page may be made again between the search for the button and the click.
  for (let i = 0; i < 20 && (await page.locator("dialog[open]").count()) === 0; i++) {
    await page.click(".worst .thumb").catch(() => {});
    await page.waitForTimeout(500);
  }
  await told();
  seen.told = await page.textContent(".unfinished");
  seen.open = await page.locator("dialog[open]").count();
}
console.log(JSON.stringify(seen));
await browser.close();
