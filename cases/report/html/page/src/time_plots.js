// Quantities over time, one plot a quantity, all with one cursor, which is the playback's time, and one zoom.
import uPlot from "uplot";
import { failedAt } from "./data.js";
import { el, replace } from "./dom.js";
import { percent, quantity, words } from "./format.js";
import { saveButtons } from "./saving.js";
import { timePicture, timeTable } from "./time_picture.js";
import { valueAt } from "./playback_data.js";
import { followTouch, liveliest, pairsOf } from "./plot_choices.js";
import { linear, logarithmic } from "./plot_scales.js";
import { colour, isDark, onTheme } from "./theme.js";
import { set, state } from "./state.js";

const first = [
  "position_error",
  "orientation_error",
  "energy_change",
  "energy_drift_synchronised",
  "angular_momentum_drift",
  "linear_momentum_drift",
  "joint_gap",
];
const height = 150;

export class TimePlots {
  constructor(results, one, data, player, root) {
    Object.assign(this, { results, one, data, player, root, plots: [], engines: [], more: false, dt: data.dt });
    const present = new Set(
      [...data.runs.values()].flatMap((run) =>
        Object.entries(run.series)
          .filter(([, c]) => c.times.length > 1 && c.values.some((v) => Math.abs(v) > 1e-17))
          .map(([name]) => name),
      ),
    );
    this.names = first.filter((name) => present.has(name));
    this.others = [...present].filter((name) => !first.includes(name));
    [this.body, this.component] = liveliest(one.scene.bodies, data);
    this.touching = pairsOf(data);
    this.stops = [player.onTick(() => this.movePlayheads()), onTheme(() => this.draw())];
    this.resize = new ResizeObserver(() => this.fit());
    this.resize.observe(root);
  }
  close() {
    this.stops.forEach((stop) => stop());
    this.resize.disconnect();
    this.plots.forEach((plot) => plot.chart.destroy());
    this.plots = [];
  }

  show(engines) {
    this.engines = engines.filter((e) => this.data.runs.has(e.name));
    this.draw();
  }

  draw() {
    this.plots.forEach((plot) => plot.chart.destroy());
    this.plots = [];
    const holders = [
      this.coordinate(),
      this.contactForce(),
      ...[...this.names, ...(this.more ? this.others : [])].map((name) => this.course(name)),
    ].filter(Boolean);
    const scale = el(
      "button.quiet",
      { type: "button", onclick: () => set({ log: !state.log }), title: "l" },
      state.log ? "logarithmic" : "linear",
    );
    const whole = state.zoom
      ? el("button.quiet", { type: "button", onclick: () => set({ zoom: null }), title: "z" }, "whole time")
      : null;
    const more = this.others.length
      ? el(
          "button.quiet",
          { type: "button", onclick: () => ((this.more = !this.more), this.draw()) },
          this.more ? "fewer" : `${this.others.length} more`,
        )
      : null;
    replace(this.root, el("div.plot-bar", {}, el("span.fine", {}, "over time"), scale, whole, more), this.coinciding(), holders);
    if (!this.data.runs.size)
      replace(this.root, el("p.fine", {}, "No run at this step size has anything to plot."));
    this.fit();
    this.movePlayheads();
  }

  // A body's coordinate itself, with the truth.
  coordinate() {
    const bodies = this.one.scene.bodies,
      moving = bodies.map((b, i) => i).filter((i) => !bodies[i].fixed);
    if (!moving.length || ![...this.data.runs.values()].some((run) => run.motion)) return null;
    if (!moving.includes(this.body)) this.body = moving[0];
    const slots = [
      ["x", 0],
      ["y", 1],
      ["z", 2],
      ["turned from the start", 3],
    ];
    const read = (motion) => {
      if (!motion) return null;
      const stride = 7 * motion.bodies,
        offset = 7 * this.body,
        v = motion.values;
      const at = (key) => {
        if (this.component < 3) return v[key * stride + offset + this.component];
        let dot = 0;
        for (let k = 3; k < 7; ++k) dot += v[offset + k] * v[key * stride + offset + k];
        return 2 * Math.acos(Math.min(1, Math.abs(dot)));
      };
      return { times: motion.times, values: Array.from(motion.times, (_, key) => at(key)) };
    };
    const series = this.engines.map((e) => [e, read(this.data.runs.get(e.name).motion)]).filter(([, c]) => c);
    const truth = read(this.data.truth?.motion);
    const choose = (options, value, pick) =>
      el(
        "select",
        { onchange: (event) => (pick(Number(event.target.value)), this.draw()), "aria-label": "what is plotted" },
        options.map(([text, key]) => el("option", { value: key, selected: key === value }, text)),
      );
    const title = el(
      "span",
      {},
      "position of ",
      choose(
        moving.slice(0, 500).map((i) => [bodies[i].name, i]),
        this.body,
        (v) => (this.body = v),
      ),
      choose(slots, this.component, (v) => (this.component = v)),
    );
    return this.plot("coordinate", title, this.component < 3 ? "m" : "rad", series, { log: false, truth });
  }

  // The size of the contact force of one pair of bodies, as each engine tells it.
  contactForce() {
    if (!this.touching.length) return null;
    this.pair = this.touching.find((pair) => pair.key === this.pair?.key) ?? this.touching[0];
    const { bodies } = this.one.scene;
    const title = el(
      "span",
      {},
      "contact force of ",
      el(
        "select",
        {
          onchange: (event) => ((this.pair = this.touching[event.target.value]), this.draw()),
          "aria-label": "which pair of bodies",
        },
        this.touching.map((pair, i) =>
          el("option", { value: i, selected: pair === this.pair }, `${bodies[pair.a].name} and ${bodies[pair.b].name}`),
        ),
      ),
    );
    const of = (engine) => this.data.runs.get(engine.name).forces?.find((one) => one.a === this.pair.a && one.b === this.pair.b);
    const series = this.engines
      .map((engine) => [engine, of(engine)])
      .filter(([, pair]) => pair)
      .map(([engine, { times, sizes }]) => [engine, { times, values: sizes }]);
    return series.length ? this.plot("contact_force", title, "N", series, { log: state.log }) : null;
  }

  course(name) {
    const series = this.engines
      .map((e) => [e, this.data.runs.get(e.name).series[name]])
      .filter(([, c]) => c && c.times.length);
    if (!series.length) return null;
    const isChange = name === "energy_change",
      unit = isChange ? "1" : (this.results.units[name] ?? "");
    const title = el(
      "span",
      {
        title:
          this.results.summaries[name] ??
          "energy since the start, as read, as a part of the truth's largest kinetic energy",
      },
      isChange ? "energy since the start" : words(name),
    );
    return this.plot(name, title, unit, series, {
      log: state.log && !isChange,
      truth: isChange ? this.data.truth?.series[name] : null,
    });
  }

  plot(name, title, unit, series, { log, truth }) {
    const lines = [...series];
    if (truth?.times.length) lines.unshift([null, truth]);
    const scale = log ? logarithmic(series.map(([, c]) => c.values)) : linear(unit, this.tameRange(series, truth));
    const tables = lines.map(([, c]) => [Array.from(c.times), Array.from(c.values, scale.put)]);
    const joined = uPlot.join(
      tables,
      tables.map((t) => t.slice(1).map(() => 1)),
    );
    const readouts = el("div.readouts"),
      holder = el("div.plot-holder");
    const figure = el(
      "figure.plot",
      { "data-plot": name },
      el(
        "figcaption",
        {},
        title,
        el("span.fine", {}, unit === "1" ? "%" : unit),
        saveButtons(`${this.one.id.replaceAll("/", "-")}-${name}`, () => timePicture(plot), () => timeTable(plot)),
        readouts,
      ),
      holder,
    );
    const chart = new uPlot(this.chartOptions(lines, scale), joined, holder);
    const playhead = el("div.playhead");
    chart.over.append(playhead);
    followTouch(chart, (time) => this.player.seek(time));
    const plot = { name, chart, holder, playhead, readouts, lines, unit, scale };
    this.plots.push(plot);
    return figure;
  }

  // Settings of uPlot for the truth (no engine) and the runs as lines over time.
  chartOptions(lines, scale) {
    const axis = {
      stroke: colour("--ink-2"),
      grid: { stroke: colour("--line"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
    };
    const truthLine = { stroke: colour("--truth"), width: 3.5, spanGaps: true, points: { show: false } };
    const runLine = (engine) => ({
      stroke: engine.hex[isDark() ? 1 : 0],
      width: 1.5,
      dash: engine.dash ?? undefined,
      spanGaps: true,
      points: { show: false },
    });
    return {
      width: 400,
      height,
      legend: { show: false },
      focus: { alpha: 0.2 },
      cursor: {
        x: false,
        y: false,
        points: { show: false },
        drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => set({ zoom: null }) },
      },
      scales: { x: { time: false, range: () => state.zoom ?? [0, this.player.duration] }, y: { range: scale.range } },
      axes: [
        { ...axis, size: 22, values: (u, ticks) => ticks.map((t) => `${Number(t.toPrecision(6))} s`) },
        { ...axis, size: 60, splits: scale.splits, values: (u, ticks) => ticks.map(scale.tick) },
      ],
      series: [{}, ...lines.map(([engine]) => (engine ? runLine(engine) : truthLine))],
      hooks: {
        setCursor: [(u) => this.hover(u)],
        setSelect: [(u) => this.zoomed(u)],
        draw: [(u) => this.markFailures(u), () => this.movePlayheads()],
      },
    };
  }

  // A dashed line where a shown run blew up or collapsed.
  markFailures(chart) {
    const { ctx, bbox } = chart;
    for (const engine of this.engines) {
      const time = failedAt(this.one.cells.find((c) => c.engine === engine.name && c.dt === this.dt));
      if (time === null || time < chart.scales.x.min || time > chart.scales.x.max) continue;
      const x = Math.round(chart.valToPos(time, "x", true));
      ctx.save();
      ctx.strokeStyle = engine.hex[isDark() ? 1 : 0];
      ctx.fillStyle = colour("--bad-solid");
      ctx.setLineDash([4, 3]);
      ctx.beginPath(), ctx.moveTo(x, bbox.top), ctx.lineTo(x, bbox.top + bbox.height), ctx.stroke();
      ctx.font = `${Math.round(11 * devicePixelRatio)}px system-ui, sans-serif`;
      ctx.fillText("✕", x - 5 * devicePixelRatio, bbox.top + 10 * devicePixelRatio);
      ctx.restore();
    }
  }

  // Engines whose error is the same within 1 % at every kept instant hide each other: they are named.
  coinciding() {
    const errors = this.engines
      .map((e) => [e.name, this.data.runs.get(e.name).series[this.names[0]]])
      .filter(([, c]) => c && c.values.length);
    const alike = (a, b) =>
      a.values.length === b.values.length &&
      a.values.every((v, i) => Math.abs(v - b.values[i]) <= 0.01 * Math.max(Math.abs(v), Math.abs(b.values[i]), 1e-12));
    const groups = [];
    for (const [name, course] of errors) {
      const group = groups.find((g) => alike(g.course, course));
      group ? group.names.push(name) : groups.push({ course, names: [name] });
    }
    const told = groups.filter((g) => g.names.length > 1).map((g) => g.names.join(" = "));
    return told.length ? el("p.fine.coinciding", {}, `Curves that coincide: ${told.join("; ")}.`) : null;
  }

  // The range of the truth and of the runs that did not blow up. Those that did would make the others invisible.
  tameRange(series, truth) {
    let low = Infinity,
      high = -Infinity;
    const include = ({ values }) =>
      values.forEach((v) => {
        if (v < low) low = v;
        if (v > high) high = v;
      });
    const tame = series.filter(
      ([engine]) => this.one.cells.find((c) => c.engine === engine.name && c.dt === this.dt)?.status !== "diverged",
    );
    for (const [, course] of tame) include(course);
    if (truth) include(truth);
    return tame.length === series.length || !(low < high)
      ? null
      : [low - 0.6 * (high - low), high + 0.6 * (high - low)];
  }

  fit() {
    for (const { chart, holder } of this.plots) {
      const width = Math.floor(holder.clientWidth);
      if (width > 0 && width !== chart.width) chart.setSize({ width, height });
    }
  }

  hover(chart) {
    if (this.player.playing || this.telling || chart.cursor.left < 0 || !chart.cursor.event) return;
    this.player.seek(chart.posToVal(chart.cursor.left, "x"));
  }

  zoomed(chart) {
    const { left, width } = chart.select;
    if (width < 3) return;
    chart.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    set({ zoom: [chart.posToVal(left, "x"), chart.posToVal(left + width, "x")] });
  }

  redraw(changed) {
    const [min, max] = state.zoom ?? [0, this.player.duration];
    if (changed.has("log")) this.draw();
    else for (const { chart } of this.plots) chart.setScale("x", { min, max });
  }

  movePlayheads() {
    const { time } = this.player;
    for (const { chart, playhead, readouts, lines, unit } of this.plots) {
      const left = chart.valToPos(time, "x"),
        { min, max } = chart.scales.x;
      playhead.style.display = time >= min - 1e-9 && time <= max + 1e-9 ? "" : "none";
      playhead.style.transform = `translateX(${left}px)`;
      while (readouts.children.length < lines.length) readouts.append(el("span", {}, el("i"), el("b")));
      lines.forEach(([engine, course], i) => {
        const value = valueAt(course, time),
          [mark, text] = readouts.children[i].children;
        mark.style.background = engine ? `var(--e${engine.index})` : "var(--truth)";
        readouts.children[i].title = engine?.name ?? "truth";
        text.textContent = value === null ? "–" : unit === "1" ? percent(value) : quantity(value, unit);
      });
    }
  }

  focus(name) {
    for (const { chart, lines } of this.plots) {
      const at = lines.findIndex(([engine]) => engine?.name === name);
      chart.setSeries(at < 0 ? null : at + 1, { focus: true });
    }
  }
}
