// A case file or a robot of one's own: dropped onto the page, or chosen. A broken one is shown with the reader's message
// and the line marked.
import { el, replace } from "../../../report/html/page/src/dom.js";
import { outside } from "./simulators.js";

const largest = 1 << 20; // bytes: a case file has thousands
const largestRobot = 64 << 20; // bytes, with its meshes
const linesAround = 4;
const isRobot = (file) => /\.(urdf|xml|mjcf|sdf|xacro)$/i.test(file.name);

export class OwnFile {
  constructor(app) {
    this.app = app;
    this.isOpen = false;
    this.root = el("div.own-file", { role: "alert" });
    this.input = el("input.visually-hidden", {
      type: "file",
      id: "file",
      accept: ".toml,.urdf,.sdf,.xml,.mjcf,.stl,.obj,.dae",
      multiple: true,
      tabindex: -1,
      "aria-label": "A case file, or a robot with its meshes",
      onchange: ({ target }) => {
        const files = [...target.files];
        target.value = ""; // the same file may be chosen again
        this.take(files);
      },
    });
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      this.take([...(event.dataTransfer?.files ?? [])]);
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
          title: "or a robot (URDF, SDF, MJCF) with its meshes; or drop them anywhere on the page",
          onclick: () => this.input.click(),
        },
        "open a file",
      ),
      this.input,
    );
  }

  async take(files) {
    if (files.length === 0) return;
    const robot = files.find(isRobot);
    if (robot) return this.takeRobot([robot, ...files.filter((one) => one !== robot)]);
    const [file] = files;
    if (file.size > largest)
      return this.say(`${file.name}: found ${file.size} bytes; a case file of at most ${largest} is read.`);
    await this.show({ path: file.name, text: await file.text() });
  }

  // The robot's file comes first. Meshes go where it looks for files of their names.
  async takeRobot(files) {
    const [robot, ...meshes] = files,
      size = files.reduce((sum, one) => sum + one.size, 0);
    if (size > largestRobot)
      return this.say(`${robot.name}: found ${size} bytes with its meshes; at most ${largestRobot} are read.`);
    const text = await robot.text(),
      bytes = async (file) => new Uint8Array(await file.arrayBuffer()),
      put = [{ name: robot.name, bytes: await bytes(robot) }];
    for (const mesh of meshes) {
      const content = await bytes(mesh);
      for (const name of placesOf(mesh.name, text)) put.push({ name, bytes: content });
    }
    await this.importRobot({ path: robot.name, text }, put, false);
  }

  async importRobot(file, put, ground) {
    const isMjcf = /<mujoco[\s>]/.test(file.text);
    if (isMjcf && !outside.some(({ name }) => name === "mujoco-js"))
      return this.say(
        `${file.path}: MuJoCo reads MJCF, and this page has none. The page with more engines has it (link above); or make a case file of it: \`rigor import ${file.path} > my-robot.toml\`.`,
      );
    const answer = await this.app.bench.importRobot(put, { ground, isMjcf });
    if (!answer.ok) return this.refuse(file, answer.why);
    await this.show({ path: file.path, text: answer.text });
    const floor = () => this.importRobot(file, put, true);
    replace(
      this.root,
      el(
        "details.robot-notes",
        { open: answer.notes.some((line) => line.startsWith("not the same robot")) },
        el("summary", {}, `${file.path}: what the import left out or assumed`),
        el("pre", { tabindex: 0 }, answer.notes.join("\n") || "nothing"),
      ),
      answer.falls
        ? el(
            "p",
            {},
            `“${answer.falls}” falls without end: nothing holds it. `,
            el("button.quiet", { type: "button", id: "add-floor", onclick: floor }, "put a floor below it"),
          )
        : null,
    );
  }

  async show(file) {
    this.app.told = [];
    Object.assign(this.app.state, { knobs: {}, at: 0, lesson: "" });
    this.app.lesson.follow();
    this.isTaking = true;
    await this.app.openFile(file);
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

// The paths by which a robot's file names a file of this name, without its folders' own links.
function placesOf(name, text) {
  const named = [...text.matchAll(/(?:filename|file|url|uri)\s*=\s*"([^"]*)"|<uri>([^<]*)<\/uri>/g)].map((found) => found[1] ?? found[2]),
    paths = named.filter((path) => path.split("/").at(-1) === name && !path.includes("://") && !path.includes("..") && !path.startsWith("/"));
  return [...new Set([name, ...paths])];
}
