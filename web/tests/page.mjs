// The page in Chromium, on runs that the program makes: node page.mjs. Environment: LAMELLA, the program; CHROMIUM, the
// browser if it is not where Debian has it. Exit code 77: there is no Chromium.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, truncateSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const PROGRAM = process.env.LAMELLA;
const BROWSER = process.env.CHROMIUM ?? "/usr/bin/chromium";
if (!existsSync(BROWSER)) {
  console.log("skipped: there is no Chromium (apt install chromium)");
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), "lamella_page_"));
const servers = [];
let browser;

function run(scene, name, ...options) {
  const result = spawnSync(PROGRAM, ["run", scene, "--out", join(folder, name), "--progress", "none", "--threads", "1", ...options], { encoding: "utf8" });
  assert.equal(result.status, 0, result.stderr);
  return join(folder, name);
}

/// Starts `lamella view`; its address, as it prints it.
function view(...words) {
  const server = spawn(PROGRAM, ["view", ...words], { stdio: ["ignore", "pipe", "pipe"] });
  servers.push(server);
  let errors = "";
  server.stderr.on("data", (text) => (errors += text));
  return new Promise((resolve, reject) => {
    let text = "";
    server.stdout.on("data", (part) => {
      text += part;
      if (text.includes("\n")) resolve({ address: text.trim(), server });
    });
    server.on("exit", (code) => reject(new Error(`lamella view ended with ${code}: ${errors}`)));
  });
}

/// What a browser without WebGL does. Pages that nobody looks at are opened in such a one: drawing is what takes time here.
function withoutWebGL() {
  const context = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return kind.startsWith("webgl") ? null : context.call(this, kind, ...more);
  };
}

async function open(address, { width = 800, height = 520, phone = false, blind = false } = {}) {
  const page = await browser.newPage({ viewport: { width, height }, isMobile: phone, hasTouch: phone });
  if (blind) await page.addInitScript(withoutWebGL);
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  await page.goto(address);
  return page;
}

const atFrame = (page, index) => page.waitForSelector(`body[data-frame="${index}"]`, { state: "attached", timeout: 60000 });

/// Mean color and mean saturation of a part of the picture, given as shares of its width and height.
async function colors(page, left, top, width, height) {
  await page.waitForTimeout(300); // two frames of a software renderer
  const box = await page.locator("#view").boundingBox();
  const clip = { x: box.x + left * box.width, y: box.y + top * box.height, width: width * box.width, height: height * box.height };
  const data = (await page.screenshot({ clip })).toString("base64");
  return page.evaluate(async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const mean = [0, 0, 0];
    let saturation = 0;
    for (let i = 0; i < data.length; i += 4) {
      const rgb = [data[i], data[i + 1], data[i + 2]];
      rgb.forEach((c, k) => (mean[k] += (4 * c) / data.length));
      saturation += (4 * (Math.max(...rgb) - Math.min(...rgb))) / Math.max(1, Math.max(...rgb)) / data.length;
    }
    return { mean, saturation, light: 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2] };
  }, data);
}

const MIDDLE = [0.4, 0.42, 0.2, 0.16];

/// What lies behind the films in the middle: all of them cut away.
async function ground(page) {
  await page.locator("#cut-axis").selectOption("0");
  await page.locator("#cut").fill("0");
  const result = await colors(page, ...MIDDLE);
  await page.locator("#cut-axis").selectOption("");
  return result;
}

/// Waits until `value()` is true; half a minute at most.
async function until(words, value) {
  for (let i = 0; i < 300; ++i) {
    if (await value()) return;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  assert.fail(`not within half a minute: ${words}`);
}

/// A frame of particles on a sphere, thicker towards the bottom, as apps/lamella/view/message.h has it.
function particleMessage(count) {
  const position = new Float32Array(3 * count);
  const thickness = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    const z = 1 - (2 * i + 1) / count;
    position.set([Math.sqrt(1 - z * z) * Math.cos(2.4 * i), Math.sqrt(1 - z * z) * Math.sin(2.4 * i), z], 3 * i);
    thickness[i] = 4e-7 * (1 - z);
  }
  const arrays = [
    { set: "points", name: "position", unit: "m", type: "f32", components: 3, count, offset: 0 },
    { set: "point_fields", name: "thickness", unit: "m", type: "f32", components: 1, count, offset: 12 * count },
  ];
  const shown = { shown: count, all: count };
  const header = Buffer.from(JSON.stringify({ solver: "particles", time: 0, time_unit: "s", step: 0, box: null, triangles: { shown: 0, all: 0 }, points: shown, scalars: [], arrays }));
  const padded = Buffer.concat([header, Buffer.alloc((4 - (header.length % 4)) % 4, " ")]);
  const intro = Buffer.alloc(16);
  intro.write("LMLA");
  [1, padded.length, 16 * count].forEach((value, k) => intro.writeUInt32LE(value, 4 + 4 * k));
  return Buffer.concat([intro, padded, Buffer.from(position.buffer), Buffer.from(thickness.buffer)]);
}

const tests = {
  async "films of 300 nm are in color, black films are dark"() {
    const colored = await open((await view(run("equilibrium/double-bubble-small", "films", "--set", "material.thickness=3e-7"))).address);
    await atFrame(colored, 1); // films at rest are shown at rest
    assert.match(await colored.locator("#time").innerText(), /^step \d+ · frame 1 of 1/);
    assert.equal(await colored.locator("#charts").isVisible(), false, "charts of one time");
    assert.match(await colored.locator("#numbers-text").innerText(), /surface energy\s+\d/);
    const film = await colors(colored, ...MIDDLE);
    const behind = await ground(colored);
    assert.ok(film.saturation > 0.3, `a film of 300 nm is gray: ${JSON.stringify(film)}`);
    assert.ok(film.light > behind.light + 20, `a film of 300 nm is dark: ${JSON.stringify(film)}`);
    // Common black films reflect a few thousandths; the slider is for films whose frames have no thickness.
    await colored.locator("#thickness").fill("5");
    const black = await colors(colored, ...MIDDLE);
    assert.ok(black.light < behind.light + 8, `a black film is bright: ${JSON.stringify({ black, behind })}`);
    assert.match(await colored.locator("#legend").innerText(), /thickness 5 nm/);
    assert.deepEqual(colored.faults, []);
  },

  async "a film run is scrubbed, colored by a field, cut and asked"() {
    const folder = run("vortex_sheet/double-bubble-small", "sheets", "--until", "0.01");
    const page = await open((await view(folder)).address);
    await atFrame(page, 0);
    assert.equal(await page.locator("#title").innerText(), "Double bubble");
    await page.keyboard.press("End");
    await atFrame(page, 4);
    await page.keyboard.press("ArrowLeft");
    await atFrame(page, 3);
    await page.locator("#scrub").fill("1");
    await atFrame(page, 1);
    assert.match(await page.locator("#time").innerText(), /0\.0025.s.*frame 1 of 4/);
    await page.locator("#play").click();
    await atFrame(page, 4);

    const before = await colors(page, ...MIDDLE);
    await page.locator("#coloring").selectOption("vertices:velocity");
    const after = await colors(page, ...MIDDLE);
    assert.ok(before.mean.some((c, k) => Math.abs(c - after.mean[k]) > 8), "the field changes nothing");
    assert.match(await page.locator("#legend").innerText(), /velocity \(magnitude\) \[m\/s\][^]*m\/s/);

    await page.locator("#coloring").selectOption("film colors");
    const box = await page.locator("#view").boundingBox();
    await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
    await page.locator("#picked-text dl").waitFor();
    assert.match(await page.locator("#picked-text").innerText(), /volume\s+4\.19·10⁻⁶.m³[^]*film to the outside/);

    assert.ok((await ground(page)).light < before.light - 20, "what is cut away is still there");

    assert.equal(await page.locator(".chart .uplot").count(), 2);
    const chart = page.locator(".chart .u-over").first();
    await chart.click({ position: { x: 0.45 * (await chart.boundingBox()).width, y: 20 } }); // nearest to frame 2 of 0 to 4
    await atFrame(page, 2);
    await page.locator("#scene summary").click();
    await page.locator("#scene-text:has-text('surface_tension')").waitFor();
    await page.locator("#provenance summary").click();
    await page.locator("#provenance-text:has-text('commit')").waitFor();

    const download = page.waitForEvent("download");
    await page.locator("#picture").click();
    const picture = readFileSync(await (await download).path());
    assert.equal(picture.subarray(1, 4).toString(), "PNG");
    assert.deepEqual(page.faults, []);
  },

  async "particles that carry films are hidden until they are wanted"() {
    const folder = run("melp/bubble-at-rest-small", "particles", "--until", "0.01", "--set", "resolution.edge_length=0.006");
    const page = await open((await view(folder)).address);
    await atFrame(page, 0);
    const film = await colors(page, ...MIDDLE);
    assert.equal(await page.locator("#particles").isChecked(), false);
    await page.locator("#particles").check();
    const grainy = await colors(page, ...MIDDLE);
    const differs = (a, b) => a.mean.some((c, k) => Math.abs(c - b.mean[k]) > 4);
    assert.ok(differs(film, grainy), `the switch changes nothing: ${JSON.stringify({ film, grainy })}`);
    await page.locator("#particles").uncheck();
    assert.ok(!differs(film, await colors(page, ...MIDDLE)), "particles are still there");
    await page.locator("#coloring").selectOption("points:velocity");
    assert.equal(await page.locator("#particles-row").isVisible(), false);
    assert.ok(differs(film, await colors(page, ...MIDDLE)), "their field does not show particles");
    assert.deepEqual(page.faults, []);
  },

  async "a damaged frame gives a message, and the others are still shown"() {
    const folder = run("vortex_sheet/double-bubble-small", "damaged", "--until", "0.005");
    truncateSync(join(folder, "frames/000001.vtp"), 4000);
    const page = await open((await view(folder)).address, { blind: true });
    await atFrame(page, 0);
    await page.keyboard.press("ArrowRight");
    await page.locator("#message:has-text('Frame 1 cannot be shown')").waitFor();
    assert.match(await page.locator("#message").innerText(), /000001\.vtp/);
    await page.keyboard.press("ArrowRight");
    await atFrame(page, 2);
    assert.equal(await page.locator("#message").isVisible(), false);
    assert.deepEqual(page.faults, []);
  },

  async "a run without frames, and a browser without WebGL, say so"() {
    const folder = run("equilibrium/catenoid-0.8-small", "bare");
    const { address } = await view(folder);
    const blind = await open(address, { blind: true });
    await blind.locator("#message:has-text('This browser has no WebGL 2')").waitFor();
    await atFrame(blind, 1);
    assert.match(await blind.locator("#numbers-text").innerText(), /surface energy\s+\d/);
    rmSync(join(folder, "frames.pvd"));
    const page = await open(address);
    await page.locator("#waiting:has-text('no frames')").waitFor();
    assert.equal(await page.locator("#look").isVisible(), false, "choices about nothing");
    assert.deepEqual([...blind.faults, ...page.faults], []);
  },

  async "a run of bubbles is shown, on a phone too"() {
    const folder = run("bubble/coarsening-2d-small", "foam", "--set", "bubble.count=400", "--set", "bubble.end_count=350");
    const { address } = await view(folder);
    const page = await open(address);
    await atFrame(page, 0);
    const foam = await colors(page, ...MIDDLE);
    assert.ok(foam.saturation > 0.3 && foam.light > 40, JSON.stringify(foam));
    assert.match(await page.locator("#legend").innerText(), /radius/);
    const box = await page.locator("#view").boundingBox();
    let text = "";
    for (let i = 0; i < 20 && !/radius/.test(text); ++i) {
      await page.mouse.click(box.x + (0.4 + 0.01 * i) * box.width, box.y + 0.5 * box.height);
      text = await page.locator("#picked-text").innerText();
    }
    assert.match(text, /radius\s+\d/);
    const id = /\bid\s+(\d+)/.exec(text)[1];
    await page.keyboard.press("End"); // others have gone by then: the bubble is followed by its id, not by its place
    await atFrame(page, Number(await page.locator("#scrub").getAttribute("max")));
    assert.match(await page.locator("#picked-text").innerText(), new RegExp(`\\bid\\s+${id}\\b|not there at this time`));
    const phone = await open(address, { width: 390, height: 780, phone: true });
    await atFrame(phone, 0);
    assert.equal(await phone.evaluate(() => document.documentElement.scrollWidth), 390, "the page is wider than the phone");
    await phone.locator("#forward").tap();
    await atFrame(phone, 1);
    const buttons = await phone.locator("#timeline button:visible").all();
    for (const button of buttons) assert.ok((await button.boundingBox()).height >= 44, "too small for a thumb");
    assert.deepEqual([...page.faults, ...phone.faults], []);
  },

  async "particles have the colors of the film that they carry, and fingers turn and zoom"() {
    const { address } = await view(join(folder, "foam"));
    const page = await browser.newPage({ viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true });
    page.faults = [];
    page.on("pageerror", (error) => page.faults.push(error.message));
    await page.route("**/api/frames/*", (route) => route.fulfill({ body: particleMessage(3000), contentType: "application/octet-stream" }));
    await page.goto(address);
    await atFrame(page, 0);
    assert.equal(await page.locator("#coloring").inputValue(), "film colors");
    assert.match(await page.locator("#legend").innerText(), /Film thickness 0\.133 – 800 nm/);
    const before = await colors(page, ...MIDDLE);
    assert.ok(before.saturation > 0.2 && before.light > 20, JSON.stringify(before));

    const touch = await page.context().newCDPSession(page);
    const fingers = async (type, ...points) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    await fingers("touchStart", [195, 150]);
    for (let y = 160; y <= 290; y += 10) await fingers("touchMove", [195, y]);
    await fingers("touchEnd");
    const turned = await colors(page, ...MIDDLE); // from the thin top now
    assert.ok(Math.abs(turned.mean[2] - before.mean[2]) + Math.abs(turned.mean[0] - before.mean[0]) > 10, JSON.stringify({ before, turned }));
    const corner = await colors(page, 0.02, 0.2, 0.1, 0.1);
    await fingers("touchStart", [185, 200], [205, 200]);
    for (let d = 20; d <= 120; d += 10) await fingers("touchMove", [195 - d, 200], [195 + d, 200]);
    await fingers("touchEnd");
    const near = await colors(page, 0.02, 0.2, 0.1, 0.1);
    assert.ok(near.light > corner.light + 10, JSON.stringify({ corner, near }));
    assert.equal(await page.locator("#picked-text dl").count(), 0, "a gesture is no tap");
    assert.deepEqual(page.faults, []);
  },

  async "nothing outside is read, and nothing is controlled without the token"() {
    const refused = spawnSync(PROGRAM, ["view", join(folder, "foam"), "--until", "3"], { encoding: "utf8" });
    assert.equal(refused.status, 2);
    assert.match(refused.stderr, /is a run already: .*--until/);
    const { address } = await view(join(folder, "foam"));
    const page = await open(address, { blind: true });
    await atFrame(page, 0);
    const answers = await page.evaluate(async () => {
      const status = async (path, options) => (await fetch(path, options)).status;
      return [
        await status("/..%2f..%2f..%2fetc%2fpasswd"),
        await status("/api/frames/..%2f..%2fscene.toml"),
        await status("/scene.toml"),
        await status("/api/run/stop", { method: "POST" }),
        await status("/api/run/stop", { method: "POST", headers: { "X-Lamella-Token": "0000" } }),
      ];
    });
    assert.deepEqual(answers, [404, 404, 404, 403, 403]);
    assert.equal(new URL(page.url()).hash, "", "the token stays in the address");
  },

  async "a run that the page started is followed, paused, resumed and stopped"() {
    const { address, server } = await view("bubble/coarsening-2d-small", "--out", join(folder, "live"), "--until", "1000", "--threads", "1", "--set", "time.frame_rate=4", "--set", "bubble.count=1500", "--set", "bubble.end_count=20");
    const page = await open(address);
    await page.waitForSelector("body[data-frame]", { state: "attached", timeout: 60000 });
    const shown = async () => Number(await page.locator("body").getAttribute("data-frame"));
    const first = await shown();
    await until("frames come by themselves", async () => (await shown()) >= first + 2);
    await page.locator("#run-pause").click();
    await page.locator("#run-state:has-text('paused')").waitFor();
    await page.locator("#run-pause").click();
    await page.locator("#run-state:has-text('going on')").waitFor();
    await page.locator("#run-stop").click();
    await page.locator("#run-state:has-text('interrupted')").waitFor({ timeout: 30000 });
    assert.ok(existsSync(join(folder, "live/checkpoint.h5")), "a stopped run has its checkpoint");
    const stranger = await open(new URL("/", address).href, { blind: true });
    await stranger.waitForSelector("body[data-frame]", { state: "attached", timeout: 60000 });
    assert.equal(await stranger.locator("#run-buttons").isVisible(), false);
    const ended = new Promise((resolve) => server.on("exit", resolve));
    server.kill("SIGINT");
    assert.equal(await ended, 0);
    await page.locator("#message:has-text('does not answer')").waitFor({ timeout: 30000 });
    assert.deepEqual(page.faults, []);
  },
};

let failures = 0;
try {
  // Software rendering: the same on every machine, and there without a screen.
  browser = await chromium.launch({ executablePath: BROWSER, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  for (const [name, test] of Object.entries(tests)) {
    const began = performance.now();
    try {
      await test();
      console.log(`ok   ${name} (${Math.round(performance.now() - began)} ms)`);
    } catch (error) {
      ++failures;
      console.log(`FAIL ${name}\n${error.stack}`);
    }
    for (const context of browser.contexts()) await context.close();
  }
} finally {
  await browser?.close();
  for (const server of servers) server.kill("SIGINT");
  await Promise.all(servers.map((server) => (server.exitCode === null ? new Promise((resolve) => server.on("exit", resolve)) : undefined)));
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failures === 0 ? 0 : 1);
