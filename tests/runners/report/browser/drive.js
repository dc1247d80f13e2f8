// node drive.js STEPS.json ANSWERS.json
// Drives headless Chromium as a reader's hands and eyes would: real keys, real swipes, a paper's width, a dark screen.
// Each step opens a page anew:
//     {name, page, width, height, dark, print, touch, bare, before: [expression…], keys: [key…], swipe: {x, from, to},
//      evaluate: [expression…], turn: [expression…], pdf: file, png: file, whole: tallest}
// Its answer is {errors, before, values, turned}. `errors` is all that the console said. `before` and `values` are what
// the expressions before and behind keys and swipe gave, in order. `bare` runs none of the page's scripts. `turn` is
// evaluated when a dark screen has turned light, or a light one dark. An expression may be a promise. The browser is
// RICOCHET_BROWSER or chromium.
"use strict";
const {spawn} = require("child_process"), fs = require("fs"), os = require("os"), path = require("path");

const browser = process.env.RICOCHET_BROWSER || "chromium",
      profile = fs.mkdtempSync(path.join(os.tmpdir(), "ricochet-browser-"));
const child = spawn(
    browser,
    [
      "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
      "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-extensions",
      "--hide-scrollbars", "--user-data-dir=" + profile, "--remote-debugging-pipe", "about:blank"
    ],
    {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
      env: {...process.env, HOME: profile, XDG_CONFIG_HOME: profile, XDG_CACHE_HOME: profile}
    });
const [to, from] = [child.stdio[3], child.stdio[4]];
child.on("error", (error) => {
  console.error(
      browser + ": " + error.message +
      "; install chromium (tests/run.sh does), or set RICOCHET_WITHOUT_BROWSER=1 to leave this check out");
  process.exit(127);
});

// Messages end in a zero byte; answers carry the number of what was asked, events none.
let last = 0, rest = Buffer.alloc(0);
const waiting = new Map(), listeners = new Set();
from.on("data", (piece) => {
  rest = Buffer.concat([rest, piece]);
  for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
    const message = JSON.parse(rest.subarray(0, end).toString());
    rest = rest.subarray(end + 1);
    if (message.id) {
      const {resolve, reject} = waiting.get(message.id);
      waiting.delete(message.id);
      message.error ? reject(new Error(JSON.stringify(message.error))) : resolve(message.result);
    } else listeners.forEach((listener) => listener(message));
  }
});
const send = (method, params = {}, sessionId) => new Promise((resolve, reject) => {
  waiting.set(++last, {resolve, reject});
  to.write(JSON.stringify({id: last, method, params, ...(sessionId ? {sessionId} : {})}) + "\0");
});
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const keyCodes = {
  Tab: 9,
  Enter: 13,
  Escape: 27,
  " ": 32,
  ArrowLeft: 37,
  ArrowRight: 39
};

// A page that was pushed has come to rest when it stays where it is for some frames.
const atRest =
    "new Promise((done) => { let last = -1, still = 0; (function look() { still = scrollY === last ? still + 1 : 0; last = scrollY; still < 6 ? requestAnimationFrame(look) : done(); })(); })";

async function take({
  page,
  width = 1400,
  height = 1000,
  dark,
  print,
  touch,
  bare,
  before = [],
  keys = [],
  swipe,
  evaluate = [],
  turn = [],
  pdf,
  png,
  whole
}) {
  const {targetId} = await send("Target.createTarget", {url: "about:blank"}),
        {sessionId} = await send("Target.attachToTarget", {targetId, flatten: true});
  const ask = (method, params) => send(method, params, sessionId), errors = [];
  const listen = (message) => {
    if (message.sessionId !== sessionId) return;
    if (message.method === "Runtime.exceptionThrown")
      errors.push(message.params.exceptionDetails.exception?.description || message.params.exceptionDetails.text);
    if (message.method === "Log.entryAdded" && message.params.entry.level !== "verbose")
      errors.push(message.params.entry.text);
    if (message.method === "Runtime.consoleAPICalled")
      errors.push(message.params.args.map((one) => one.value || one.description).join(" "));
  };
  listeners.add(listen);
  for (const domain of ["Page", "Runtime", "Log"]) await ask(domain + ".enable");
  await ask("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: 1, mobile: Boolean(touch)});
  if (touch) await ask("Emulation.setTouchEmulationEnabled", {enabled: true, maxTouchPoints: 2});
  const light = (off) =>
      ask("Emulation.setEmulatedMedia",
          {media: print ? "print" : "", features: [{name: "prefers-color-scheme", value: off ? "dark" : "light"}]});
  await light(dark);
  if (bare) await ask("Emulation.setScriptExecutionDisabled", {value: true});
  const loaded = new Promise((resolve) => listeners.add(function wait(message) {
    if (message.sessionId === sessionId && message.method === "Page.loadEventFired") {
      listeners.delete(wait);
      resolve();
    }
  }));
  await ask("Page.navigate", {url: "file://" + page});
  await loaded;
  const value = async (expression) => {
    const {result, exceptionDetails} =
        await ask("Runtime.evaluate", {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) errors.push(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value === undefined ? null : result.value;
  };
  const frames = () => value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
  if (!bare) await frames();
  const earlier = [];
  for (const expression of before) earlier.push(await value(expression));
  for (const key of keys) {
    const [, held, name] = /^(Shift\+|Control\+)?(.+)$/.exec(key), modifier = {"Shift+": 8, "Control+": 2}[held] || 0,
                   code = {
                     key: name,
                     code: name === " " ? "Space" : name,
                     windowsVirtualKeyCode: keyCodes[name] || name.charCodeAt(0),
                     modifiers: modifier
                   };
    const text = name === "Enter" ? "\r" : name.length === 1 && modifier !== 2 ? name : "";
    await ask("Input.dispatchKeyEvent", {type: "keyDown", ...code, ...(text ? {text} : {})});
    await ask("Input.dispatchKeyEvent", {type: "keyUp", ...code});
  }
  if (swipe) {
    const at = (y) => [{x: swipe.x, y}], parts = 12;
    await ask("Input.dispatchTouchEvent", {type: "touchStart", touchPoints: at(swipe.from)});
    for (let k = 1; k <= parts; ++k) {
      await ask(
          "Input.dispatchTouchEvent",
          {type: "touchMove", touchPoints: at(swipe.from + (swipe.to - swipe.from) * k / parts)});
      await pause(16);
    }
    await ask("Input.dispatchTouchEvent", {type: "touchEnd", touchPoints: []});
    await value(atRest);
  }
  const values = [], turned = [];
  for (const expression of evaluate) values.push(await value(expression));
  if (turn.length) {
    await light(!dark);
    await frames();
    for (const expression of turn) turned.push(await value(expression));
  }
  if (pdf)
    fs.writeFileSync(
        pdf,
        Buffer.from((await ask("Page.printToPDF", {preferCSSPageSize: true, printBackground: true})).data, "base64"));
  if (png)
    fs.writeFileSync(
        png,
        Buffer.from(
            (await ask("Page.captureScreenshot", {
              captureBeyondViewport: Boolean(whole),
              ...(whole ? {
                clip: {
                  x: 0,
                  y: 0,
                  width,
                  height: Math.min(whole, await value("document.documentElement.scrollHeight")),
                  scale: 1
                }
              } :
                          {})
            })).data,
            "base64"));
  listeners.delete(listen);
  await send("Target.closeTarget", {targetId});
  return {errors, before: earlier, values, turned};
}

(async () => {
  const answers = {};
  for (const step of JSON.parse(fs.readFileSync(process.argv[2], "utf8"))) answers[step.name] = await take(step);
  fs.writeFileSync(process.argv[3], JSON.stringify(answers));
  const gone = child.exitCode !== null || child.signalCode !== null;
  const ended = new Promise((resolve) => gone ? resolve() : child.on("exit", resolve));
  await Promise.race([send("Browser.close").catch(() => {}).then(() => ended), pause(5000)]);
  child.kill("SIGKILL");  // one that has ended takes no harm
  await ended;
  // Processes of the browser may write for a moment after it.
  fs.rmSync(profile, {recursive: true, force: true, maxRetries: 100, retryDelay: 100});
  process.exit(0);
})().catch((error) => {
  console.error(error.stack || error);
  child.kill("SIGKILL");
  process.exit(1);
});
