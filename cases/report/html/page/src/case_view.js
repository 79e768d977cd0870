// One case: the truth, the runs in motion, their series over time, and the summary over all step sizes.
import { asideOf, cellOf, dtOf, judgement, hasNumbers, isAgainstTolerance, isHeldToItself, nothingMoves } from "./data.js";
import { el, replace } from "./dom.js";
import { isNumber, quantity } from "./format.js";
import { caseHeading } from "./case_heading.js";
import { convergence, stabilityMap, workPrecision } from "./charts.js";
import { gatesTable, numbersTable, sceneFile, settingsTable } from "./case_tables.js";
import { frictionFan } from "./friction_chart.js";
import { loadCase } from "./playback_data.js";
import { cheapest, curvesOfCase, isCoreMethod, isExternal, isTimed } from "./frontier.js";
import { FrontierChart, lengthOrAngle } from "./frontier_chart.js";
import { divergence, partingAnswer, PartingView } from "./parting_view.js";
import { Player } from "./player.js";
import { commands, repairs } from "./repair.js";
import { schemeSplit } from "./scheme_tables.js";
import { Stage } from "./stage.js";
import { TimePlots } from "./time_plots.js";
import { errorOfTrial, nextTrial, trialBar, trialOf, trialSpread } from "./trials.js";
import { onChange, openAll, openCase, set, site, state } from "./state.js";

const shownAtFirst = 6;

// Lets the page process pending input.
const pause = () => new Promise((resolve) => setTimeout(resolve));

const part = (id, title, text, ...content) =>
  el("section.part", { id }, el("h2", {}, title), text ? el("p.fine", {}, text) : null, content);

export class CaseView {
  constructor(results, one, root) {
    (this.results = results), (this.one = one), (this.root = root);
    this.dt = dtOf(one, state.dt);
    this.player = new Player(one.duration);
    this.parting = divergence?.case === one.id ? new PartingView(divergence, this.player) : null;
    this.chips = el("div.chips", { role: "group", "aria-label": "Engines shown" });
    this.stageBox = el("section.stage", { "aria-label": "Playback" });
    this.plotsBox = el("section.plots", { "aria-label": "Quantities over time" });
    this.answer = el("div.answer-first", {});
    this.chart = new FrontierChart({
      timed: isTimed(results),
      isOneCase: true,
      pickTolerance: (tolerance) => set({ tolerance }),
    });
    (this.across = el("div.across")), (this.fan = el("div.fan"));
    this.steps = el("div.segments", { role: "group", "aria-label": "Step size" });
    (this.trials = el("div.trial-bar")), (this.spread = el("div.spread"));
    replace(root, caseHeading(this), this.bar(), el("div.motion", {}, this.stageBox, el("div.beside-motion", {}, this.chart.root, this.plotsBox)), this.parting?.root, this.across);
    this.drawAnswer();
    this.stop = onChange((changed) => this.follow(changed));
    this.load();
  }

  close() {
    this.closed = true;
    this.barSize.disconnect();
    this.stop(), this.parting?.close(), this.player.close(), this.stage?.close(), this.plots?.close();
  }

  get engines() {
    return this.results.engines.filter((e) => cellOf(this.one, e.name, this.dt.text));
  }
  get runnable() {
    return this.engines.filter((e) => cellOf(this.one, e.name, this.dt.text).status !== "unsupported");
  }
  get shown() {
    if (state.engines) return this.runnable.filter((e) => state.engines.has(e.name));
    // The engines that are not ours, then those of ours that err least, for the eye to compare with.
    const foreign = this.runnable.filter((e) => !e.core),
      error = (e) => cellOf(this.one, e.name, this.dt.text).metrics?.[this.one.main]?.value ?? Infinity;
    const own = this.runnable.filter((e) => e.core).sort((a, b) => error(a) - error(b));
    const chosen = new Set([...foreign, ...own].slice(0, Math.max(shownAtFirst, foreign.length)).map((e) => e.name));
    return this.runnable.filter((e) => chosen.has(e.name));
  }

  // The engine and step to take in this case, and who fails at the step shown.
  drawAnswer() {
    const { tolerance } = state,
      curves = curvesOfCase(this.results, this.one);
    const best = cheapest(curves, tolerance, isExternal),
      own = cheapest(curves, tolerance, isCoreMethod);
    const within = lengthOrAngle(tolerance);
    const isComparable = curves.length > 0 && isAgainstTolerance(this.one) && !this.one.truth.still;
    const title = !isComparable
      ? this.one.truth.still
        ? nothingMoves(1)
        : this.nearestToRecording()
      : best
        ? ["For ", el("b", {}, within), " take ", el("b", {}, best.curve.engine), " at ", el("b", {}, `${best.point.dt} s`)]
        : curves.some(isExternal)
          ? `No engine stays within ${within} at the steps tried`
          : own
            ? ["Within ", el("b", {}, within), ": ", el("b", {}, own.curve.engine), " at ", el("b", {}, `${own.point.dt} s`)]
            : `Nothing stays within ${within} at the steps tried`;
    const bad = this.engines
      .map((engine) => ({ engine, verdict: judgement(cellOf(this.one, engine.name, this.dt.text)) }))
      .filter(({ verdict }) => verdict.kind === "bad");
    const fails = bad.map(({ engine, verdict }) => `${engine.name} (${verdict.word})`);
    const few = fails.slice(0, 4).join(", ") + (fails.length > 4 ? ` and ${fails.length - 4} more` : "");
    replace(
      this.answer,
      this.parting ? partingAnswer(divergence) : el("h1", {}, title),
      el(
        "p.beside",
        {},
        own && best && !this.parting ? `Rigor's core: ${own.curve.engine} at ${own.point.dt} s. ` : "",
        bad.length ? `Failed at ${this.dt.text} s: ${few}.` : `Nothing fails at ${this.dt.text} s.`,
      ),
    );
    this.chart.root.hidden = !isComparable;
    if (isComparable) this.chart.draw({ curves, tolerance, chosen: best ?? own, focus: null });
  }

  // Of all runs the one with the smallest mean error. A mean that lacks trials may lack the hard ones.
  nearestToRecording() {
    const { main } = this.one,
      hasAllTrials = (cell) => (cell.trials ?? []).every(({ metrics }) => isNumber(metrics[main])),
      isCompared = (cell) => isNumber(cell.metrics?.[main]?.value) && !isHeldToItself(cell, main) && hasAllTrials(cell),
      compared = main.startsWith("mean_") ? this.one.cells.filter(isCompared) : [];
    const best = compared.sort((a, b) => a.metrics[main].value - b.metrics[main].value)[0];
    if (!best) return "No error can be compared in this case";
    const error = quantity(best.metrics[main].value, this.results.units[main]);
    return ["Nearest to the recording: ", el("b", {}, best.engine), ` at ${best.dt} s, ${error}`];
  }

  // It stays in sight; the picture below it has to know how high it is.
  bar() {
    const bar = el("div.bar", {}, this.steps, this.trials, this.chips);
    this.barSize = new ResizeObserver(() => this.root.style.setProperty("--bar", `${bar.offsetHeight}px`));
    this.barSize.observe(bar);
    return bar;
  }

  drawBar() {
    replace(
      this.steps,
      this.one.dt.map((dt) =>
        el(
          "button",
          { type: "button", "aria-pressed": String(dt.text === this.dt.text), onclick: () => set({ dt: dt.text }) },
          `dt ${dt.text} s`,
        ),
      ),
    );
    replace(this.trials, trialBar(this.context));
    const shown = new Set(this.shown.map((e) => e.name));
    const chip = (engine, i) => {
      const cell = cellOf(this.one, engine.name, this.dt.text),
        verdict = judgement(cell);
      const error = this.one.trials.length
        ? errorOfTrial(this.one, cell, trialOf(this.one))
        : cell.metrics?.[this.one.main]?.value;
      const value = hasNumbers(cell) ? quantity(error, this.results.units[this.one.main]) : "";
      // The verdict on several trials is the worst one's, so the error of the one shown says more.
      const hasOwnValue = verdict.kind === "drift" || (this.one.trials.length > 0 && isNumber(error));
      return el(
        `button.chip${engine.stock ? ".is-stock" : ""}`,
        {
          type: "button",
          "aria-pressed": String(shown.has(engine.name)),
          disabled: cell.status === "unsupported",
          title: `${engine.name}: ${verdict.word}${asideOf(cell)}`,
          style: { "--engine": `var(--e${engine.index})` },
          onclick: (event) => this.toggle(engine, event.shiftKey),
          onmouseenter: () => this.plots?.focus(engine.name),
          onmouseleave: () => this.plots?.focus(null),
        },
        el("span.swatch"),
        el("span.name", {}, engine.name.replace("core:", "")),
        el(
          `span.word.is-${verdict.kind}`,
          {},
          verdict.kind === "good" ? value : `${verdict.sign} ${hasOwnValue ? value : verdict.word}`,
        ),
        i < 10 ? el("kbd", {}, (i + 1) % 10) : null,
      );
    };
    replace(
      this.chips,
      this.engines.map((engine) =>
        chip(engine, this.runnable.indexOf(engine) < 0 ? 99 : this.runnable.indexOf(engine)),
      ),
      el("button.quiet", { type: "button", onclick: () => this.show(this.runnable) }, "all"),
      el("button.quiet", { type: "button", onclick: () => this.show([]) }, "none"),
    );
  }

  show(engines) {
    set({ engines: new Set(engines.map((e) => e.name)) });
  }
  toggle(engine, alone) {
    const names = new Set(this.shown.map((e) => e.name));
    if (alone) return this.show([engine]);
    names.has(engine.name) ? names.delete(engine.name) : names.add(engine.name);
    set({ engines: names });
  }

  async load() {
    const wanted = this.dt.text,
      trial = trialOf(this.one),
      isOutdated = () => this.closed || wanted !== this.dt.text || trial !== trialOf(this.one);
    this.drawBar(), this.drawAcross(), this.drawAnswer();
    const data = await loadCase(this.results, this.one, wanted, trial);
    if (isOutdated()) return;
    this.data = data;
    this.stage?.close(), this.plots?.close();
    this.player.dt = this.dt.seconds;
    this.player.duration = (this.one.trials.length && data.truth?.last) || this.one.duration;
    this.stage = new Stage(this.results, this.one, data, this.player, this.stageBox);
    this.stage.show(this.shown);
    await pause();
    if (isOutdated()) return;
    this.plots = new TimePlots(this.results, this.one, data, this.player, this.plotsBox);
    this.plots.show(this.shown);
    this.drawFan();
    this.player.seek(Math.min(state.time, this.player.duration));
    this.root.dataset.loaded = [this.one.id, wanted, this.one.trials[trial]].join(" ").trim();
  }

  get context() {
    return { results: this.results, one: this.one, dt: this.dt, shown: this.shown };
  }

  // Called when the motions are loaded, which contain the positions of rest.
  drawFan() {
    const fan = this.data?.dt === this.dt.text ? frictionFan(this.context, this.data) : null;
    const text =
      "All should stop after the same way. Friction that is a cone leaves an arc; a pyramid brakes harder along its diagonals and dents it.";
    replace(this.fan, fan ? part("friction", "Friction by direction", text, fan) : null);
  }

  // Each trial's error; the one that is played stands out.
  drawSpread() {
    const spread = trialSpread(this.context),
      text = "Each dot is a trial, and the line is the median. Click a dot to play its trial beside the recorded motion.";
    replace(this.spread, spread ? part("trials", "Trials", text, spread) : null);
  }

  drawAcross() {
    const { context } = this;
    const split = schemeSplit(context),
      converged = convergence(context),
      worked = workPrecision(context);
    replace(
      this.across,
      part("numbers", `At dt = ${this.dt.text} s`, null, numbersTable(context)),
      this.spread,
      this.fan,
      split
        ? part(
            "scheme",
            "Scheme or engine?",
            "The core runs a scheme replica (twin) of an engine: its published scheme at the same step. What the twin is off from the truth is the scheme's; only what the engine is off from its twin is unexplained.",
            split,
          )
        : null,
      converged
        ? part(
            "convergence",
            "Convergence",
            "Error against step size; the figure behind a name is the order fitted, dotted lines are what orders 1, 2 and 4 fall by.",
            converged,
          )
        : null,
      worked
        ? part(
            "work",
            "Work and precision",
            "Error against CPU time per simulated second: lower and further left is better.",
            worked,
          )
        : null,
      part(
        "stability",
        "Stability",
        "Each bar reaches to the largest dt that does not blow up within 30 s; dots are the runs.",
        stabilityMap(context),
      ),
      part("repair", "How to fix it", null, repairs(context, state.tolerance)),
      part("commands", "Reproduce it", null, commands(context, state.tolerance)),
      part("gates", "Gates", null, gatesTable(context)),
      part("settings", "Settings in force", "As read back from each engine in this case.", settingsTable(context)),
      part("file", "The case file", null, sceneFile(this.one)),
    );
    this.drawFan(), this.drawSpread();
  }

  follow(changed) {
    if (changed.has("case")) return;
    if (changed.has("tolerance")) this.drawAnswer(), this.drawAcross();
    if (changed.has("dt") && dtOf(this.one, state.dt).text !== this.dt.text) {
      this.dt = dtOf(this.one, state.dt);
      this.load();
    } else if (changed.has("trial")) {
      this.load();
    } else if (changed.has("engines")) {
      this.drawBar(), this.drawAcross();
      this.stage?.show(this.shown), this.plots?.show(this.shown);
    }
    if (changed.has("layout")) this.stage?.arrange();
    if (changed.has("log") || changed.has("zoom")) this.plots?.redraw(changed);
    if (changed.has("time") && Math.abs(this.player.time - state.time) > 1e-9) this.player.seek(state.time);
  }

  goTo(index) {
    const elsewhere = site?.[index < this.results.cases.indexOf(this.one) ? "before" : "after"];
    if (elsewhere) return location.assign(elsewhere.address);
    const next = this.results.cases[index];
    if (next) openCase(next.id);
  }

  key(event) {
    const at = this.results.cases.indexOf(this.one),
      { player } = this;
    const digit = "1234567890".indexOf(event.code.startsWith("Digit") ? event.code.slice(5) : event.key);
    if (digit >= 0 && this.runnable[digit]) return this.toggle(this.runnable[digit], event.shiftKey), true;
    const onButton = event.target.closest?.("button, a, summary");
    const actions = {
      " ": () => player.toggle(),
      ArrowLeft: () => player.step(event.shiftKey ? -10 : -1),
      ArrowRight: () => player.step(event.shiftKey ? 10 : 1),
      Home: () => player.seek(0),
      End: () => player.seek(player.duration),
      a: () => this.show(this.runnable),
      n: () => this.show([]),
      o: () => set({ layout: "overlay" }),
      s: () => set({ layout: "side" }),
      g: () => this.stage?.flip("truth"),
      t: () => this.stage?.flip("trails"),
      c: () => this.stage?.flip("contacts"),
      i: () => this.stage?.flip("joints"),
      e: () => this.stage?.flip("forces"),
      "+": () => player.faster(2),
      "-": () => player.faster(0.5),
      f: () => this.stage?.frameAll(),
      l: () => set({ log: !state.log }),
      z: () => set({ zoom: null }),
      ",": () => nextTrial(this.one, -1),
      ".": () => nextTrial(this.one, 1),
      j: () => this.goTo(at + 1),
      k: () => this.goTo(at - 1),
      d: () =>
        set({
          dt: this.one.dt[(this.one.dt.findIndex((dt) => dt.text === this.dt.text) + 1) % this.one.dt.length].text,
        }),
      Escape: openAll,
    };
    if (!actions[event.key] || (event.key === " " && onButton)) return false;
    actions[event.key]();
    return true;
  }
}
