// A case file of one's own: dropped onto the page, or chosen. A broken one is shown with the reader's message and the
// line marked.
import { el, replace } from "../../../report/html/page/src/dom.js";

const largest = 1 << 20; // bytes: a case file has thousands
const linesAround = 4;

export class OwnFile {
  constructor(app) {
    this.app = app;
    this.isOpen = false;
    this.root = el("div.own-file", { role: "alert" });
    this.input = el("input.visually-hidden", {
      type: "file",
      id: "file",
      accept: ".toml",
      tabindex: -1,
      "aria-label": "A case file",
      onchange: (event) => this.take(event.target.files[0]),
    });
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      this.take(event.dataTransfer?.files[0]);
    });
  }

  button() {
    return el(
      "div.file-choice",
      {},
      el(
        "button.quiet",
        {
          type: "button",
          id: "open-file",
          title: "or drop it anywhere on the page",
          onclick: () => this.input.click(),
        },
        "open a case file",
      ),
      this.input,
    );
  }

  async take(file) {
    if (!file) return;
    if (/\.(urdf|xml|mjcf|sdf)$/i.test(file.name))
      return this.say(
        `${file.name}: the laboratory reads case files (TOML). \`rigor import ${file.name} > my-robot.toml\` makes one of a robot's file.`,
      );
    if (file.size > largest)
      return this.say(`${file.name}: found ${file.size} bytes; a case file of at most ${largest} is read.`);
    const text = await file.text();
    this.app.told = [];
    Object.assign(this.app.state, { knobs: {}, at: 0, lesson: "" });
    this.app.lesson.follow();
    this.isTaking = true;
    await this.app.openFile({ path: file.name, text });
    this.isTaking = false;
  }

  clear() {
    this.isOpen = Boolean(this.isTaking);
    replace(this.root);
  }

  say(text) {
    replace(this.root, el("p.error", {}, text));
  }

  // The reader's message begins with "path:line:column:".
  refuse(file, why) {
    const place = why.startsWith(`${file.path}:`) ? why.slice(file.path.length + 1).match(/^(\d+)/) : null,
      line = place ? Number(place[1]) : 0,
      lines = file.text.split("\n");
    const from = Math.max(1, line - linesAround),
      to = Math.min(lines.length, line + linesAround),
      shown = [];
    for (let n = from; line > 0 && n <= to; ++n) {
      const text = `${String(n).padStart(4)}  ${lines[n - 1]}`;
      shown.push(n === line ? el("mark", {}, text) : text, "\n");
    }
    replace(
      this.root,
      el("p.error", { id: "file-error" }, why),
      shown.length > 0
        ? el("pre", { tabindex: 0, "aria-label": `Lines ${from} to ${to} of ${file.path}` }, shown)
        : null,
      el("p.fine", {}, "The scene that was shown before stays."),
      el("button.quiet", { type: "button", onclick: () => replace(this.root) }, "close"),
    );
  }
}
