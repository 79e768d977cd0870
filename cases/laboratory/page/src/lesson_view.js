// The guided lessons: screens that set a state of the laboratory and say what to look at. The numbers in their texts
// come from the runs as they go on.
import { el, replace } from "../../../report/html/page/src/dom.js";
import { figure } from "./figures.js";
import explicitEuler from "./lessons/explicit-euler.json";
import impulse from "./lessons/impulse.json";
import joints from "./lessons/joints.json";
import orientation from "./lessons/orientation.json";
import semiImplicit from "./lessons/semi-implicit.json";

export const lessons = [explicitEuler, orientation, semiImplicit, impulse, joints];

export class LessonView {
  constructor(app) {
    this.app = app;
    this.root = el("section.lesson", { "aria-label": "Lesson" });
    this.screen = null;
  }

  // The lesson that the address names, "NAME.SCREEN"; without one, the list of lessons.
  follow() {
    const { state } = this.app,
      [id, number = "1"] = state.lesson.split("."),
      lesson = lessons.find((one) => one.id === id);
    if (state.lesson && !lesson) this.app.told.push(`There is no lesson “${id.slice(0, 40)}”.`), (state.lesson = "");
    const at = Math.min(Math.max(1, Math.round(Number(number)) || 1), lesson?.screens.length ?? 1) - 1;
    this.lesson = lesson ?? null;
    this.at = at;
    this.screen = lesson?.screens[at] ?? null;
    this.draw();
  }

  get plots() {
    return this.screen?.plots ?? null;
  }

  open(lesson, at) {
    this.app.set({ ...lesson.screens[at].state, lesson: `${lesson.id}.${at + 1}` }).then(() => this.app.showPlots());
    this.follow();
  }

  close() {
    this.app.state.lesson = "";
    this.follow();
    this.app.showPlots(), this.app.writeAddress();
  }

  draw() {
    if (!this.screen)
      return void replace(
        this.root,
        el(
          "nav.lessons",
          { "aria-label": "Lessons" },
          el("span.fine", {}, "Lessons:"),
          lessons.map((one) =>
            el("button", { type: "button", "data-lesson": one.id, onclick: () => this.open(one, 0) }, one.title),
          ),
        ),
      );
    const { lesson, at, screen } = this,
      step = (by, label, isOn) =>
        el(
          "button",
          {
            type: "button",
            disabled: !isOn,
            "data-go": label.toLowerCase(),
            onclick: () => this.open(lesson, at + by),
          },
          label,
        );
    this.figures = [];
    replace(
      this.root,
      el(
        "div.lesson-card",
        {},
        el("p.fine", {}, `Lesson: ${lesson.title}, screen ${at + 1} of ${lesson.screens.length}`),
        el("h2", {}, screen.title),
        screen.text.map((text) => el("p", {}, this.filled(text))),
        el(
          "div.lesson-tools",
          {},
          step(-1, "Back", at > 0),
          step(1, "Next", at + 1 < lesson.screens.length),
          this.again(),
          el("button.quiet", { type: "button", "data-go": "leave", onclick: () => this.close() }, "leave the lesson"),
        ),
      ),
    );
  }

  again() {
    return el(
      "button.quiet",
      { type: "button", "data-go": "again", onclick: () => this.open(this.lesson, this.at) },
      "set this screen up again",
    );
  }

  // {NAME} and {NAME K} become figures of the scene, or of run K.
  filled(text) {
    return text.split(/(\{[^}]*\})/).map((part) => {
      if (!part.startsWith("{")) return part;
      const [name, run] = part.slice(1, -1).split(" "),
        node = el("output.figure-now", { "data-figure": part.slice(1, -1) }, "…");
      this.figures.push({ node, name, run: run === undefined ? null : Number(run) });
      return node;
    });
  }

  tick() {
    if (!this.screen) return;
    for (const { node, name, run } of this.figures) {
      const text = figure(this.app.bench, name, run);
      if (node.textContent !== text) node.textContent = text;
    }
  }
}
