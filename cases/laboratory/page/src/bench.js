// The bench: one scene, up to four runs in simulators of their own, the truth, and the clock that all of them keep.
import { kindOf } from "./run_names.js";
import { Simulator } from "./simulators.js";

const perReading = 6; // time, energy, orthonormality, position error, orientation error, joint gap (calls.cpp)
const atFirst = 3; // simulators of runs
const longestCall = 60; // ms: more steps in one call, and the picture stutters
const tellEvery = 1000; // ms
const mostTelling = 0.1; // the share of time in which runs are judged and not stepped, while they play

export class Bench {
  constructor(onChange) {
    this.onChange = onChange; // (what) => …: "loaded", "stepped", "truth", "sentences"
    this.runs = [];
    this.pool = Array.from({ length: atFirst }, () => new Simulator()); // they start while the page is built
    this.truth = null; // { table: Float64Array, columns, kind, provisional }
    this.playing = false;
    this.speed = 1;
    this.done = 0; // steps
    this.generation = 0;
    this.reader = new Simulator(); // reads case files and puts findings into words
  }

  // The facts of a case file; { ok: false, why } for one that is broken.
  read(file) {
    return this.reader.call({ call: "read", ...file });
  }
  // A robot's file as a case file, with the meshes that it names: [{ name, bytes }], the robot's first.
  // MJCF needs the simulators beside MuJoCo.
  importRobot(files, { ground, isMjcf }) {
    if (isMjcf) this.mjcfReader ??= new Simulator("mujoco-js");
    const reader = isMjcf ? this.mjcfReader : this.reader;
    return reader.callWith(files, { call: "import", path: files[0].name, ground });
  }
  methods() {
    return this.reader.call({ call: "methods" });
  }

  get dt() {
    const [above, below] = this.dtText.split("/").map(Number);
    return above / below;
  }
  get time() {
    return this.done * this.dt;
  }
  get mostSteps() {
    return Math.floor(this.duration / this.dt + 1e-9);
  }
  get hasEnded() {
    return this.done >= this.mostSteps || (this.runs.length > 0 && this.runs.every((run) => run.ended));
  }

  // Makes every run anew. `at`: steps to make at once.
  async load({ file, facts, knobs, names, dtText, at = 0 }) {
    const mine = ++this.generation;
    Object.assign(this, { file, facts, knobs, dtText, duration: facts.duration, done: 0, truth: null, words: null });
    this.runs.forEach((run) => this.retire(run.simulator));
    this.runs = names.map((name) => ({
      name,
      simulator: this.taken(kindOf(name)),
      readings: [],
      poses: null,
      ended: "",
      why: "",
    }));
    this.solveTruth(mine);
    await Promise.all(this.runs.map((run) => this.loadRun(run)));
    if (mine !== this.generation) return;
    this.onChange("loaded");
    if (at > 0) await this.advance(Math.min(at, this.mostSteps));
    this.tell();
  }

  get what() {
    return { ...this.file, knobs: this.knobs, dt: this.dtText };
  }

  async loadRun(run) {
    const answer = await run.simulator.call({ call: "load", ...this.what, run: run.name });
    if (!answer.ok) return void ((run.why = answer.why), (run.ended = answer.why));
    run.settings = answer.settings;
    run.readings = [...answer.numbers.subarray(0, perReading)];
    run.poses = answer.numbers.slice(perReading);
  }

  // Simulators that are idle are used again; a busy one is of no more use.
  taken(kind) {
    const at = this.pool.findIndex((one) => one.kind === kind);
    return at < 0 ? new Simulator(kind) : this.pool.splice(at, 1)[0];
  }
  retire(simulator) {
    if (simulator.isBusy || simulator.hasTrapped || this.pool.length > 4) simulator.close();
    else this.pool.push(simulator);
  }

  // First a stand-in, which is there at once; then the truth, which may take seconds.
  async solveTruth(mine) {
    if (this.solver?.isBusy) this.solver.close(), (this.solver = null);
    this.solver ??= new Simulator();
    const { solver, what } = this;
    for (const provisional of [true, false]) {
      const answer = await solver.call({ call: "truth", ...what, provisional });
      if (mine !== this.generation || answer.is_closed) return;
      if (answer.ok) await this.compare(answer, mine);
      else if (!provisional) await this.doWithoutTruth(answer.why, mine);
      this.onChange("truth");
    }
    this.tell();
  }

  // Where bodies touch, small differences soon make other motions: then the stand-in is no measure either.
  async doWithoutTruth(whyNone, mine) {
    const { table, columns, ...header } = this.truth ?? {};
    if (this.facts.touches && table) await this.compare({ ...header, numbers: new Float64Array() }, mine);
    this.truth = this.facts.touches ? { ...header, whyNone } : { ...this.truth, whyNone };
  }

  async compare({ numbers, ok, ...header }, mine) {
    this.truth = { ...header, table: numbers, columns: 13 * header.bodies + 1 };
    await this.loaded(mine);
    for (const run of this.runs) {
      if (run.why) continue;
      await run.simulator.call({ call: "compare", ...header }, numbers);
      const answer = await run.simulator.call({ call: "readings", from: 0 });
      if (mine === this.generation && answer.ok) run.readings = [...answer.numbers];
    }
  }
  async loaded(mine) {
    while (mine === this.generation && this.runs.some((run) => !run.poses && !run.why))
      await new Promise((r) => setTimeout(r, 5));
  }

  // The truth's poses now; null where there is none.
  truthPoses() {
    const { truth } = this;
    if (!truth?.table || (this.done + 1) * truth.columns > truth.table.length) return null;
    const row = truth.table.subarray(this.done * truth.columns, (this.done + 1) * truth.columns);
    if (row[row.length - 1] > 1e-2) return null; // past its horizon
    const poses = new Float64Array(7 * truth.bodies);
    for (let i = 0; i < truth.bodies; ++i) poses.set(row.subarray(13 * i, 13 * i + 7), 7 * i);
    return poses;
  }

  async advance(to) {
    await this.stepAll(to);
    this.onChange("stepped");
  }

  // All runs to step `to`, in calls that are short enough for the picture.
  async stepAll(to) {
    const mine = this.generation;
    while (this.done < to && mine === this.generation && !this.hasEnded) {
      const count = Math.min(to - this.done, Math.max(1, Math.round(this.pace ?? 20)));
      const began = performance.now();
      await Promise.all(this.runs.map((run) => this.stepRun(run, count)));
      if (mine !== this.generation) return;
      this.pace = (count * longestCall) / Math.max(1, performance.now() - began);
      this.done += count;
    }
  }

  async stepRun(run, count) {
    if (run.ended) return;
    const mine = this.generation,
      answer = await run.simulator.call({ call: "step", count });
    if (mine !== this.generation) return;
    if (!answer.ok) return void ((run.why = answer.why), (run.ended = answer.why));
    const cut = perReading * answer.steps;
    for (const value of answer.numbers.subarray(0, cut)) run.readings.push(value);
    run.poses = answer.numbers.slice(cut);
    run.ended = answer.ended === "the end of the run" ? "" : answer.ended;
  }

  reading(run, step = this.done) {
    const at = perReading * Math.min(step, run.readings.length / perReading - 1);
    if (at < 0) return null;
    const [time, energy, orthonormality, position, orientation, gap] = run.readings.slice(at, at + perReading);
    return { time, energy, orthonormality, position, orientation, gap };
  }
  column(run, index) {
    const values = [];
    for (let at = index; at < run.readings.length; at += perReading) values.push(run.readings[at]);
    return values;
  }

  play() {
    if (this.playing) return;
    this.playing = true;
    this.before = null;
    requestAnimationFrame((now) => this.frame(now));
  }
  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.tell();
  }

  async frame(now) {
    if (!this.playing) return;
    const passed = this.before === null ? 0 : Math.min(0.1, (now - this.before) / 1000);
    this.before = now;
    this.due = Math.max(this.due ?? 0, this.time);
    this.due = Math.min(this.due + passed * this.speed, this.time + 0.1 * this.speed + this.dt);
    const to = Math.min(this.mostSteps, Math.floor(this.due / this.dt + 1e-9));
    const isDue = to > this.done;
    if (isDue) await this.stepAll(to);
    if (this.hasEnded) this.playing = false;
    const pause = Math.max(tellEvery, (this.tellingTook ?? 0) / mostTelling);
    if (!this.playing || now - (this.told ?? 0) > pause) (this.told = now), this.tell();
    // The next frame is asked for before the picture is: then the runs go on while it is drawn.
    if (this.playing) requestAnimationFrame((later) => this.frame(later));
    if (isDue || !this.playing) this.onChange("stepped");
  }

  // Judges all runs and asks for the sentences on them. One question at a time; the last one is not lost.
  async tell() {
    if (this.isTelling) return void (this.mustTellAgain = true);
    this.isTelling = true;
    const mine = this.generation,
      began = performance.now(),
      { runs } = this,
      judged = (run) => (run.why ? { ok: false } : run.simulator.call({ call: "judge", brief: this.playing })),
      rows = [];
    for (const [k, answer] of (await Promise.all(runs.map(judged))).entries()) {
      if (!answer.ok) continue;
      rows.push({ run: runs[k].name, cell: answer.cell });
      runs[k].cell = JSON.parse(answer.cell).result;
    }
    this.tellingTook = performance.now() - began;
    const words =
      mine === this.generation ? await this.reader.call({ call: "explain", ...this.what, runs: rows }) : null;
    this.isTelling = false;
    if (words && mine === this.generation) (this.words = words), this.onChange("sentences");
    if (this.mustTellAgain) (this.mustTellAgain = false), this.tell();
  }

  // A new start with what there is.
  async reset(changes = {}) {
    this.due = 0;
    await this.load({
      file: this.file,
      facts: this.facts,
      knobs: this.knobs,
      names: this.runs.map((run) => run.name),
      dtText: this.dtText,
      ...changes,
    });
  }
}
