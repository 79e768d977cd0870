#!/usr/bin/env python3
"""Builds the documentation site: the pages of the repository, the reference that the program writes, and the API.

  cases/docs/build.py --rigor build/release/rigor --version 1.0.0 --out build/release/docs HEADER…

The target `docs` calls it with the public headers. It stages the pages, runs Doxygen for the API's XML, and Sphinx for the
site. Any warning of either is an error. The variable RIGOR_DOCS_SOURCES is the address below which links to source files
point; without it such links become plain text.
"""
import argparse
import os
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True  # the sources stay as they are
from schema_page import schema_page  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ROOMS = ["core", "adapters", "cases", "bench", "tests"]
SCHEMAS = {
    "cases/case/case.schema.json": ("case-file", "Case file"),
    "cases/case/family.schema.json": ("family-file", "Family file"),
    "cases/report/json/results.schema.json": ("results", "results.json"),
    "adapters/plugin/protocol.schema.json": ("protocol", "Plug-in protocol"),
    "adapters/plugin/scene.schema.json": ("scene", "Scenes as JSON"),
}
# The tables in the code, and the pages that the program writes from them.
TABLES = {
    "cases/cli/commands.cpp": "commands",
    "cases/metrics/metrics.cpp": "metrics",
    "cases/truth/truths.cpp": "truths",
    "adapters/engines.cpp": "engines-and-methods",
}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")


def repository_pages():
    """Path in the repository -> path in the site, of every page."""
    pages = {}
    for path in sorted(ROOT.glob("*.md")) + sorted((ROOT / ".github").glob("*.md")):
        pages[path.relative_to(ROOT).as_posix()] = f"project/{path.name}"
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.md")):
            name = path.relative_to(ROOT).as_posix()
            if "node_modules" not in name:
                inside = name.removeprefix("cases/docs/")
                pages[name] = f"rooms/{name}" if inside == name else inside
    return pages


def rewritten(text, page, places):
    """The text of a page, with its links led to the site. `places`: path in the repository -> path in the site."""

    def led(match):
        mark, shown, target = match.groups()
        if re.match(r"[a-z]+:", target) or target.startswith("#"):
            return match[0]
        path, _, heading = target.partition("#")
        name = posixpath.normpath(posixpath.join(posixpath.dirname(page), path))
        if not (ROOT / name).exists():
            sys.exit(f"{page}: no file for the link {target}")
        if name in places:
            there = posixpath.relpath(places[name], posixpath.dirname(places[page]) or ".")
            return f"{mark}[{shown}]({there}{'#' + heading if heading else ''})"
        sources = os.environ.get("RIGOR_DOCS_SOURCES")
        return f"[{shown}]({sources}/{name})" if sources else shown

    parts = re.split(r"(^```.*?^```[^\n]*$)", text, flags=re.MULTILINE | re.DOTALL)
    return "".join(part if i % 2 else LINK.sub(led, part) for i, part in enumerate(parts))


def documented(text):
    """A header's comments in the form that Doxygen reads: // becomes ///, and ///< behind code. Deduction guides go.
    So do the rooms' inline namespaces: users say rigor::Scene, and Doxygen would find rigor::scene in each header."""
    text = re.sub(r"namespace rigor::inline \w+", "namespace rigor", text)
    text = re.sub(r"template <[^>]*>\n\w+\([^)]*\) -> [^;]*;\n", "", text)
    if text.startswith("/*"):  # a header for C
        text = re.sub(r"^(\s*)/\* ", r"\1/** ", text, flags=re.MULTILINE).replace("; /* ", "; /**< ")
        text = re.sub(r"typedef struct (\w+) \{(.*?)^\} \1;", r"struct \1 {\2};", text, flags=re.MULTILINE | re.DOTALL)
        return text.replace("/** ", "/** \\file\n", 1)
    out = []
    for line in text.split("\n"):
        match = re.match(r"^(\s*)(.*?)(\s*)// (.*)$", line)
        if not match or match[2].startswith(("//", "}")) or match[2].count('"') % 2:
            out.append(line)
            continue
        words = match[4].split("`")
        for i in range(0, len(words), 2):
            words[i] = re.sub(r"([\\@<>#])", r"\\\1", words[i])
        behind = "///< " if match[2] else "/// "
        out.append(match[1] + match[2] + match[3] + behind + "`".join(words))
    if out and out[0].startswith("///"):
        out.insert(0, r"/// \file")
    return "\n".join(out)


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def reference(rigor):
    """Name -> text of the pages that the program writes."""
    text = subprocess.run([rigor, "completion", "reference"], check=True, capture_output=True, text=True).stdout
    pages = {}
    for page in re.split(r"^(?=# )", text, flags=re.MULTILINE):
        if page:
            title = page[2:].partition("\n")[0]
            pages[title.lower().replace(" ", "-")] = page
    return pages


def toctree(caption, names):
    return "".join(["```{toctree}\n:hidden:\n", f":caption: {caption}\n\n", *(f"{n.removesuffix('.md')}\n" for n in names), "```\n\n"])


def stage(args, source):
    places = repository_pages()
    for path, (name, _) in SCHEMAS.items():
        places[path] = f"reference/{name}.md"
    for path, name in TABLES.items():
        places[path] = f"reference/{name}.md"
    for header in args.headers:
        places[header] = f"api/{header.replace('/', '-').removesuffix('.h')}.md"
    places[".github/report.png"] = "project/report.png"
    for page in repository_pages():
        write(source / places[page], rewritten((ROOT / page).read_text(encoding="utf-8"), page, places))
    shutil.copy(ROOT / ".github/report.png", source / "project/report.png")
    pages = reference(args.rigor)
    for name in TABLES.values():
        if name not in pages:
            sys.exit(f"{args.rigor} completion reference has no page {name}")
    for name, text in pages.items():
        write(source / f"reference/{name}.md", text)
    for path, (name, title) in SCHEMAS.items():
        write(source / f"reference/{name}.md", schema_page(ROOT / path, title))
    for header in args.headers:
        write(source / places[header], f"# {header}\n\n```{{doxygenfile}} {header}\n```\n")
    index = source / "index.md"
    index.write_text(index.read_text(encoding="utf-8") + "\n" + contents(places, pages, args.headers), encoding="utf-8")


def contents(places, pages, headers):
    """The site's table of contents."""
    def below(folder):
        return sorted(p for p in set(places.values()) if p.startswith(folder))

    rooms = [f"rooms/{room}/README.md" for room in ROOMS]
    return "".join([
        toctree("Concepts", [f"concepts/{n}" for n in ("measurement", "truths", "scheme-replicas", "contact-methods", "steps")]),
        toctree("How to", [f"guides/{n}" for n in ("laboratory", "own-case", "own-engine", "own-robot", "two-runs", "measured-motion", "python", "python-engines", "ci", "site", "embedding")]),
        toctree("Reference", [f"reference/{name}" for name in pages] + [f"reference/{name}" for name, _ in SCHEMAS.values()]),
        toctree("API", [places[header] for header in headers]),
        toctree("Rooms", rooms + [p for p in below("rooms/") if p not in rooms]),
        toctree("Project", [p for p in below("project/") if p.endswith(".md")]),
    ])


def run_doxygen(args, work):
    filter_call = f"python3 {HERE / 'build.py'} --documented"
    warnings = work / "doxygen-warnings.txt"
    inputs = " ".join(f'"{ROOT / header}"' for header in args.headers)
    write(work / "Doxyfile", f"""INPUT = {inputs}
INPUT_FILTER = "{filter_call}"
STRIP_FROM_PATH = "{ROOT}"
OUTPUT_DIRECTORY = "{work}"
GENERATE_XML = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
EXTRACT_ALL = YES
AUTOLINK_SUPPORT = NO
WARN_LOGFILE = "{warnings}"
QUIET = YES
""")
    subprocess.run(["doxygen", work / "Doxyfile"], check=True)
    text = warnings.read_text(encoding="utf-8")
    if text.strip():
        sys.exit(f"warnings of Doxygen:\n{text}")


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--documented":  # the filter of Doxygen
        print(documented(pathlib.Path(sys.argv[2]).read_text(encoding="utf-8")))
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigor", required=True, help="the program")
    parser.add_argument("--version", required=True)
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder of the site; its old content is removed")
    parser.add_argument("headers", nargs="+", metavar="HEADER", help="a public header, from the top of the repository")
    args = parser.parse_args()
    out = args.out.resolve()
    work = out.with_name(out.name + "-work")
    for folder in (out, work):
        shutil.rmtree(folder, ignore_errors=True)
    stage(args, work / "source")
    run_doxygen(args, work)
    environment = {**os.environ, "RIGOR_DOCS_VERSION": args.version, "RIGOR_DOCS_XML": str(work / "xml")}
    done = subprocess.run(
        ["sphinx-build", "-q", "-W", "--keep-going", "-c", HERE, "-d", work / "doctrees", work / "source", out], env=environment)
    if done.returncode:
        sys.exit("the site has warnings; see above")
    pages = sum(1 for _ in out.rglob("*.html"))
    print(f"{pages} pages in {out}/index.html")


if __name__ == "__main__":
    main()
