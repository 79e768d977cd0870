// What is chosen by hand: the scene, the methods, the step, the knobs, and the clock.
import { el, replace } from "../../../report/html/page/src/dom.js";
import { digits, quantity, seconds } from "../../../report/html/page/src/format.js";
import { mostRuns, speeds, steps } from "./address.js";
import { nameOf, partsOf, shortName } from "./run_names.js";
import { slider } from "./slider.js";

// Those of the course come first.
export const ofCourse = [
  ["springs/fixed-spring", "Spring, fixed"],
  ["springs/body-springs", "Springs between bodies"],
  ["contact/collision", "Collision"],
  ["ballistic/orientation-updates", "Orientation updates"],
];

const engineNames = { bullet: "Bullet", ode: "ODE" };

export class Controls {
  constructor(app) {
    this.app = app;
    this.scene = el("section.scene-choice");
    this.runs = el("section.run-choice", { "aria-label": "Methods" });
    this.knobs = el("section.knobs", { "aria-label": "Values" });
    this.transport = el("div.transport.lab-transport", { role: "group", "aria-label": "Clock" });
    this.buildTransport();
  }

  draw() {
    this.drawScene(), this.drawRuns(), this.drawKnobs();
  }

  drawScene() {
    const { state, facts, cases, file } = this.app;
    const isOwn = this.app.ownFile.isOpen,
      courseIds = ofCourse.map(([id]) => id),
      option = (id, label) => el("option", { value: id, selected: !isOwn && id === state.case }, label),
      families = new Map();
    for (const { id, title } of cases) {
      const family = id.split("/")[0];
      if (!courseIds.includes(id)) families.set(family, [...(families.get(family) ?? []), [id, title]]);
    }
    const select = el(
      "select",
      { id: "scene", onchange: (event) => this.app.change({ case: event.target.value, lesson: "" }) },
      isOwn ? el("option", { selected: true }, file.path) : null,
      el(
        "optgroup",
        { label: "The course" },
        ofCourse.filter(([id]) => cases.some((one) => one.id === id)).map(([id, label]) => option(id, label)),
      ),
      [...families].map(([family, rows]) =>
        el(
          "optgroup",
          { label: family },
          rows.map(([id]) => option(id, id)),
        ),
      ),
    );
    const about = aboutOf(file.text);
    replace(
      this.scene,
      el("div.scene-row", {}, el("label.control", {}, el("span", {}, "Scene"), select), this.app.ownFile.button()),
      el("h1", {}, facts.title),
      about ? el("details.about-scene", {}, el("summary", {}, "About this scene"), el("p", {}, about)) : null,
    );
  }

  drawRuns() {
    const { state } = this.app;
    replace(
      this.runs,
      el("h2", {}, "Methods"),
      state.runs.map((name, k) => this.runRow(name, k)),
      el(
        "div.run-tools",
        {},
        state.runs.length < mostRuns
          ? el("button", { type: "button", id: "add-run", onclick: () => this.addRun() }, "Add a method")
          : null,
        this.layoutButton(),
        this.flagButton("truth", "truth as a ghost"),
      ),
    );
  }

  layoutButton() {
    const isSide = this.app.state.layout === "side";
    return el(
      "button.quiet",
      { type: "button", id: "layout", onclick: () => this.app.change({ layout: isSide ? "overlay" : "side" }) },
      isSide ? "show overlaid" : "show side by side",
    );
  }
  flagButton(flag, label) {
    const isOn = this.app.state[flag];
    return el(
      "button.quiet",
      {
        type: "button",
        id: `flag-${flag}`,
        "aria-pressed": String(isOn),
        onclick: () => this.app.change({ [flag]: !isOn }),
      },
      label,
    );
  }

  // The method with its orientation update and contact method, where the scene asks for one.
  runRow(name, k) {
    const { methods, facts, bench } = this.app,
      parts = partsOf(name),
      row = methods.find((one) => one.name === parts.method);
    const method = el(
      "select",
      {
        "aria-label": `Method ${k + 1}`,
        title: row.summary,
        onchange: (event) =>
          this.setRun(k, {
            method: event.target.value,
            options: keptOptions(
              parts.options,
              methods.find((one) => one.name === event.target.value),
            ),
          }),
      },
      this.methodGroups(parts.method),
    );
    const failure = bench.runs[k]?.why || bench.runs[k]?.ended;
    return el(
      "div.run-row",
      { "data-run": name },
      el(`span.line.run-${k}`, { "aria-hidden": "true" }),
      method,
      this.optionSelect(k, parts, row, "orientation"),
      Object.keys(facts.contact_lacks).length > 0 || this.hasContacts()
        ? this.optionSelect(k, parts, row, "contact")
        : null,
      this.app.state.runs.length > 1
        ? el(
            "button.quiet",
            { type: "button", "aria-label": `Remove ${shortName(name)}`, onclick: () => this.removeRun(k) },
            "✕",
          )
        : null,
      failure ? el("p.error", {}, failure) : null,
    );
  }
  hasContacts() {
    return this.app.facts.knobs.some((knob) => knob.name === "restitution");
  }

  optionSelect(k, parts, row, name) {
    const option = row.options.find((one) => one.name === name);
    if (!option || (name === "contact" && !this.hasContacts())) return null;
    const lacks = name === "contact" ? this.app.facts.contact_lacks : {};
    return el(
      "select",
      {
        "aria-label": `${name === "contact" ? "Contact method" : "Orientation update"} of method ${k + 1}`,
        title: option.meaning,
        "data-option": name,
        onchange: (event) => this.setRun(k, { ...parts, options: { ...parts.options, [name]: event.target.value } }),
      },
      el(
        "option",
        { value: "", selected: !parts.options[name] },
        `${name}: ${name === "contact" ? "as the core chooses" : option.default}`,
      ),
      option.choices.map((choice) =>
        el(
          "option",
          {
            value: choice,
            selected: parts.options[name] === choice,
            disabled: Boolean(lacks[choice]),
            title: lacks[choice] ?? "",
          },
          `${name}: ${choice}`,
        ),
      ),
    );
  }

  // The core's own methods, those that repeat an engine's scheme, and the engines themselves.
  methodGroups(chosen) {
    const { methods, facts } = this.app;
    const option = (one) => {
      const lacks = facts.lacks[one.name];
      const label =
        one.engine ?? (one.twin_of ? `${one.name} (the scheme of ${engineNames[one.twin_of] ?? one.twin_of})` : one.name);
      return el(
        "option",
        { value: one.name, selected: one.name === chosen, disabled: Boolean(lacks), title: lacks ?? one.summary },
        label + (lacks ? " – not here" : ""),
      );
    };
    const groups = [
      ["Rigor's core", (one) => !one.engine && !one.twin_of],
      ["engines", (one) => one.engine],
      ["schemes of engines, in the core", (one) => one.twin_of],
    ];
    return groups
      .map(([label, has]) => [label, methods.filter(has)])
      .filter(([, rows]) => rows.length > 0)
      .map(([label, rows]) => el("optgroup", { label }, rows.map(option)));
  }

  setRun(k, parts) {
    const runs = [...this.app.state.runs];
    runs[k] = nameOf(parts);
    this.app.change({ runs });
  }
  addRun() {
    const { state, methods, facts } = this.app;
    const used = state.runs.map((name) => partsOf(name).method);
    const next = methods.find((one) => !used.includes(one.name) && !facts.lacks[one.name] && !one.twin_of);
    this.app.change({ runs: [...state.runs, nameOf({ method: next.name, options: {} })] });
  }
  removeRun(k) {
    this.app.change({ runs: this.app.state.runs.filter((_, i) => i !== k) });
  }

  drawKnobs() {
    const { state, facts } = this.app;
    const isChanged = Object.keys(state.knobs).length > 0;
    replace(
      this.knobs,
      this.stepSlider(),
      facts.knobs.map((knob) => this.knob(knob)),
      el(
        "button.quiet",
        { type: "button", id: "own-values", disabled: !isChanged, onclick: () => this.app.change({ knobs: {} }) },
        "the scene's own values",
      ),
    );
  }

  // Fine steps to the right.
  stepSlider() {
    const { state } = this.app,
      at = steps.indexOf(state.dt),
      text = `1/${state.dt} s`;
    return slider({
      ...{ id: "dt", label: "Step dt", text, min: 0, max: steps.length - 1, step: 1, value: at },
      set: (value) => this.app.change({ dt: steps[value] }),
      show: (value) => `1/${steps[value]} s`,
    });
  }

  knob(knob) {
    const { state } = this.app,
      value = state.knobs[knob.name] ?? knob.value,
      isInfinite = value === "infinite";
    const show = (x) => (knob.unit ? quantity(x, knob.unit, 3) : digits(x));
    const set = (x) => {
      const knobs = { ...state.knobs, [knob.name]: x };
      if (x === knob.value || Math.abs(x / knob.value - 1) < 1e-9) delete knobs[knob.name];
      this.app.change({ knobs });
    };
    const put = knob.logarithmic ? Math.log10 : (x) => x,
      get = knob.logarithmic ? (x) => Number((10 ** x).toPrecision(3)) : (x) => Number(x.toPrecision(3));
    const within = (x) => Math.min(knob.most, Math.max(knob.least, x));
    const row = slider({
      ...{ id: `knob-${knob.name}`, label: knob.label, text: isInfinite ? "infinite" : show(value) },
      ...{ min: put(knob.least), max: put(knob.most), step: (put(knob.most) - put(knob.least)) / 200 },
      value: isInfinite ? put(knob.most) : put(value),
      isOff: isInfinite,
      set: (x) => set(within(get(x))),
      show: (x) => show(within(get(x))),
    });
    if (knob.infinite)
      row.append(
        el(
          "label.infinite",
          {},
          el("input", {
            type: "checkbox",
            checked: isInfinite,
            id: `knob-${knob.name}-infinite`,
            onchange: (event) => set(event.target.checked ? "infinite" : knob.value === "infinite" ? 0.5 : knob.value),
          }),
          "infinite",
        ),
      );
    return row;
  }

  buildTransport() {
    const button = (id, label, sign, action, isQuiet = true) =>
      el(
        isQuiet ? "button.quiet" : "button.play",
        { type: "button", id, "aria-label": label, title: label, onclick: action },
        sign,
      );
    this.playButton = button("play", "Play", "▶", () => this.app.togglePlay(), false);
    this.speed = el(
      "select",
      {
        id: "speed",
        "aria-label": "Speed",
        onchange: (event) => this.app.change({ speed: Number(event.target.value) }),
      },
      speeds.map((one) => el("option", { value: one }, one < 1 ? `slow: × ${one}` : `× ${one}`)),
    );
    this.clock = el("output.clock", { id: "clock" });
    this.course = el("progress", { max: 1, value: 0, "aria-label": "Time passed" });
    replace(
      this.transport,
      button("reset", "Back to the start (r)", "↺", () => this.app.reset()),
      this.playButton,
      button("step", "One step (→)", "step ›", () => this.app.step()),
      this.course,
      this.clock,
      this.speed,
    );
  }

  tick() {
    const { bench, state } = this.app;
    this.playButton.textContent = bench.playing ? "❚❚" : "▶";
    this.playButton.setAttribute("aria-label", bench.playing ? "Pause" : "Play");
    this.speed.value = String(state.speed);
    this.course.value = bench.mostSteps > 0 ? bench.done / bench.mostSteps : 0;
    this.clock.textContent = `${seconds(bench.time, 3)} · step ${bench.done}`;
  }

  faster(by) {
    const at = speeds.indexOf(this.app.state.speed) + by;
    if (speeds[at]) this.app.change({ speed: speeds[at] });
  }
  finer(by) {
    const at = steps.indexOf(this.app.state.dt) + by;
    if (steps[at]) this.app.change({ dt: steps[at] });
  }
}

const keptOptions = (options, method) =>
  Object.fromEntries(Object.entries(options).filter(([name]) => method.options.some((one) => one.name === name)));

// The comment at the head of a case file.
export function aboutOf(text) {
  const lines = [];
  for (const line of text.split("\n")) {
    if (!line.startsWith("#")) break;
    lines.push(line.replace(/^#:?\s?/, ""));
  }
  return lines.join(" ").trim();
}
