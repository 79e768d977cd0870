// A headless Chromium, driven through chromedriver as the W3C's WebDriver says: HTTP and JSON, nothing else.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";

const freePort = () =>
  new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

export class Browser {
  // `webgl: false` takes WebGL away.
  static async open({ width = 1360, height = 900, dark = false, webgl = true, touch = false } = {}) {
    const browser = new Browser(),
      port = await freePort();
    browser.base = `http://127.0.0.1:${port}`;
    // Profiles go with the browser: a driver that is stopped leaves them behind.
    browser.files = await mkdtemp(join(tmpdir(), "rigor-browser-"));
    browser.driver = spawn("chromedriver", [`--port=${port}`, "--silent"], {
      stdio: "ignore",
      env: { ...process.env, TMPDIR: browser.files },
    });
    browser.driver.on("error", (error) => {
      browser.failure = error;
    });
    for (let i = 0; i < 100; ++i) {
      if (browser.failure) throw new Error(`chromedriver cannot be started: ${browser.failure.message}`);
      try {
        if ((await fetch(`${browser.base}/status`)).ok) break;
      } catch {
        await sleep(50);
      }
    }
    const args = [
      "--headless=new",
      "--no-sandbox",
      "--disable-dev-shm-usage",
      `--window-size=${width},${height}`,
      "--hide-scrollbars",
      "--force-device-scale-factor=1",
      ...(webgl
        ? ["--enable-unsafe-swiftshader"]
        : ["--disable-gpu", "--disable-3d-apis", "--disable-software-rasterizer"]),
    ];
    const { sessionId } = await browser.call("POST", "/session", {
      capabilities: {
        alwaysMatch: {
          browserName: "chrome",
          "goog:loggingPrefs": { browser: "ALL" },
          "goog:chromeOptions": { args },
        },
      },
    });
    browser.session = `/session/${sessionId}`;
    await browser.emulate(width, height, { dark, touch });
    return browser;
  }

  async call(method, path, body) {
    const answer = await fetch(this.base + path, {
      method,
      body: body === undefined ? undefined : JSON.stringify(body),
    });
    const { value } = await answer.json();
    if (!answer.ok) throw new Error(`${path.split("/").pop()}: ${value.error}: ${value.message.split("\n")[0]}`);
    return value;
  }
  post(path, body = {}) {
    return this.call("POST", this.session + path, body);
  }
  devtools(cmd, params) {
    return this.post("/goog/cdp/execute", { cmd, params });
  }

  async emulate(width, height, { dark = false, touch = false } = {}) {
    await this.devtools("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: touch });
    await this.devtools("Emulation.setTouchEmulationEnabled", { enabled: touch });
    await this.devtools("Emulation.setEmulatedMedia", {
      features: [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }],
    });
  }

  goTo(url) {
    return this.post("/url", { url });
  }
  run(script, ...args) {
    return this.post("/execute/sync", { script, args });
  }
  // What a promise comes to.
  callLater(expression) {
    const script = `const done = arguments[arguments.length - 1]; (${expression}).then(done, (e) => done({ violations: [{ id: "failed", help: String(e), nodes: [] }] }))`;
    return this.post("/execute/async", { script, args: [] });
  }
  // `script` is an expression; waits until it is true, and returns it.
  async until(script, what = script, seconds = 20) {
    const end = Date.now() + 1000 * seconds;
    for (;;) {
      const value = await this.run(`return ${script}`);
      if (value) return value;
      if (Date.now() > end) throw new Error(`waited ${seconds} s in vain: ${what}`);
      await sleep(30);
    }
  }

  async keys(...values) {
    const actions = values.flatMap((value) => [
      { type: "keyDown", value },
      { type: "keyUp", value },
    ]);
    await this.post("/actions", { actions: [{ type: "key", id: "keyboard", actions }] });
  }
  // Moves the mouse or a finger over the page, in CSS pixels of the window, with the button down from the first point
  // on.
  async drag(points, { pointerType = "mouse" } = {}) {
    const [start, ...rest] = points.map(([x, y]) => ({
      type: "pointerMove",
      duration: 40,
      x: Math.round(x),
      y: Math.round(y),
    }));
    await this.post("/actions", {
      actions: [
        {
          type: "pointer",
          id: pointerType,
          parameters: { pointerType },
          actions: [
            { ...start, duration: 0 },
            { type: "pointerDown", button: 0 },
            ...rest,
            { type: "pointerUp", button: 0 },
          ],
        },
      ],
    });
  }
  async hover(x, y) {
    await this.post("/actions", {
      actions: [
        {
          type: "pointer",
          id: "mouse",
          parameters: { pointerType: "mouse" },
          actions: [{ type: "pointerMove", duration: 30, x: Math.round(x), y: Math.round(y) }],
        },
      ],
    });
  }

  async screenshot({ whole = false } = {}) {
    const { data } = await this.devtools("Page.captureScreenshot", {
      format: "png",
      captureBeyondViewport: whole,
      ...(whole
        ? {
            clip: {
              x: 0,
              y: 0,
              scale: 1,
              ...(await this.run(
                "return {width: document.documentElement.clientWidth, height: Math.min(9000, document.documentElement.scrollHeight)}",
              )),
            },
          }
        : {}),
    });
    return Buffer.from(data, "base64");
  }
  // The page's errors since the last call.
  async complaints() {
    const log = await this.post("/se/log", { type: "browser" });
    return log
      .filter((entry) => entry.level === "SEVERE" || entry.level === "WARNING")
      .map((entry) => `${entry.level}: ${entry.message}`);
  }

  async close() {
    try {
      await this.call("DELETE", this.session);
    } catch {
      /* gone already */
    }
    const ended = once(this.driver, "exit");
    if (this.driver.kill()) await ended;
    await rm(this.files, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
  }
}
