// The laboratory: its state, and what follows from a change of it.
import { el, replace } from "../../../report/html/page/src/dom.js";
import { addressOf, defaults, dtText, fittingKnobs, stateOf } from "./address.js";
import { Bench } from "./bench.js";
import { Controls } from "./controls.js";
import { Findings } from "./findings.js";
import { LessonView } from "./lesson_view.js";
import { LivePlots } from "./live_plots.js";
import { OwnFile } from "./own_file.js";
import { Picture } from "./picture.js";
import { fittingRun, learnEngines } from "./run_names.js";

const plotEvery = 100; // ms

export class App {
  constructor(root, cases) {
    this.root = root;
    this.cases = cases; // [{ id, text }]
    this.told = []; // what of the address or a file could not be shown as asked
    this.bench = new Bench((what) => this.follow(what));
    this.controls = new Controls(this);
    this.findings = new Findings(this);
    this.lesson = new LessonView(this);
    this.ownFile = new OwnFile(this);
    this.notes = el("div.told", { role: "status" });
    this.pictureBox = el("section.picture", { "aria-label": "The motion" });
    this.plotBox = el("section.plots", { "aria-label": "Quantities over time" });
    replace(
      root,
      this.lesson.root,
      this.notes,
      this.ownFile.root,
      el(
        "div.lab",
        {},
        el("div.lab-main", {}, this.controls.scene, this.pictureBox, this.controls.transport, this.findings.root),
        el("div.lab-side", {}, this.controls.runs, this.controls.knobs, this.plotBox),
      ),
    );
    this.picture = new Picture(this.pictureBox);
    this.plots = new LivePlots(this.plotBox);
    window.addEventListener("hashchange", () => location.hash !== this.written && this.open());
  }

  async start() {
    const answer = await this.bench.methods();
    if (!answer.ok) throw new Error(answer.why);
    this.methods = answer.methods;
    learnEngines(this.methods);
    await this.open();
  }

  // Shows what the address says.
  async open() {
    this.told = [];
    const ids = this.cases.map((one) => one.id),
      state = stateOf(location.hash, ids, this.told);
    state.runs = state.runs.map((name) => fittingRun(name, this.methods, this.told));
    if (state.runs.length === 0) state.runs = [...defaults.runs];
    this.state = state;
    this.lesson.follow();
    await this.openFile(this.fileOf(state.case));
  }

  fileOf(id) {
    const { text } = this.cases.find((one) => one.id === id);
    return { path: `${id}.toml`, text };
  }

  // A case file, of the suite or one's own.
  async openFile(file) {
    const facts = await this.bench.read(file);
    if (!facts.ok) return this.ownFile.refuse(file, facts.why);
    this.ownFile.clear();
    Object.assign(this, { file, facts });
    this.state.knobs = fittingKnobs(this.state.knobs, facts.knobs, this.told);
    this.picture.show(facts.scene);
    await this.load();
  }

  async load() {
    const { bench, state, file, facts } = this;
    this.controls.draw();
    this.writeAddress();
    const wasPlaying = bench.playing;
    bench.playing = false;
    bench.speed = state.speed;
    await bench.load({ file, facts, knobs: state.knobs, names: state.runs, dtText: dtText(state), at: state.at });
    if (wasPlaying) bench.play();
  }

  // A change by hand. It starts the runs again unless it changes only how they are shown.
  change(changes) {
    const before = { ...this.state };
    Object.assign(this.state, changes);
    if (changes.case !== undefined && changes.case !== before.case) {
      Object.assign(this.state, { knobs: {}, at: 0 });
      this.told = [];
      return this.openFile(this.fileOf(changes.case));
    }
    const isShown = Object.keys(changes).every((key) => ["layout", "truth", "log", "speed"].includes(key));
    if (!isShown) return (this.state.at = changes.at ?? 0), this.load();
    this.bench.speed = this.state.speed;
    this.controls.draw();
    this.showPlots();
    this.update();
    this.writeAddress();
  }

  // All at once, as a lesson's screen asks.
  async set(state) {
    this.told = [];
    this.bench.pause();
    this.state = { ...defaults, knobs: {}, ...state };
    this.state.runs = this.state.runs.map((name) => fittingRun(name, this.methods, this.told));
    await this.openFile(this.fileOf(this.state.case));
  }

  follow(what) {
    if (what === "loaded") this.showPlots();
    if (what === "truth") this.picture.frameAll(this.bench.truth), this.plots.update();
    this.update();
    if (what === "loaded" || what === "sentences") this.findings.draw(), this.controls.drawRuns();
    if (what === "stepped" && !this.bench.playing)
      this.plots.update(), (this.state.at = this.bench.done), this.writeAddress();
  }

  showPlots() {
    this.plots.show(this.bench, { log: this.state.log, only: this.lesson.plots });
  }

  update() {
    this.picture.update(this.bench, this.state);
    this.controls.tick();
    this.findings.tick();
    this.lesson.tick();
    replace(
      this.notes,
      this.told.map((text) => el("p", {}, text)),
    );
    const now = performance.now();
    if (now - (this.plotted ?? 0) > plotEvery) (this.plotted = now), this.plots.update();
    this.root.dataset.step = this.bench.done;
  }

  writeAddress() {
    this.written = addressOf(this.state, this.ownFile.isOpen);
    if (location.hash !== this.written) history.replaceState(null, "", this.written);
  }

  togglePlay() {
    const { bench } = this;
    if (bench.playing) return bench.pause(), this.follow("stepped");
    if (bench.hasEnded) return this.reset().then(() => bench.play());
    bench.play();
    this.update();
  }
  async step() {
    this.bench.pause();
    await this.bench.advance(this.bench.done + 1);
    this.bench.tell();
  }
  async reset() {
    this.bench.playing = false;
    this.state.at = 0;
    await this.load();
  }

  key(event) {
    const actions = {
      " ": () => this.togglePlay(),
      ArrowRight: () => this.step(),
      r: () => this.reset(),
      o: () => this.change({ layout: "overlay" }),
      s: () => this.change({ layout: "side" }),
      g: () => this.change({ truth: !this.state.truth }),
      l: () => this.change({ log: !this.state.log }),
      f: () => this.picture.frameAll(this.bench.truth),
      "+": () => this.controls.faster(1),
      "-": () => this.controls.faster(-1),
      "<": () => this.controls.finer(1),
      ">": () => this.controls.finer(-1),
    };
    const onButton = event.target.closest?.("button, a, summary");
    if (!actions[event.key] || (event.key === " " && onButton)) return false;
    actions[event.key]();
    return true;
  }
}
