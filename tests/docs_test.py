#!/usr/bin/env python3
"""Builds the documentation site and checks it: every internal link leads to a file and a heading, the search knows the
pages, and the generated reference is complete.

  tests/docs_test.py SITE cases/docs/build.py ARGUMENT…       the arguments are those of the target `docs`
"""
import html.parser
import json
import pathlib
import re
import subprocess
import sys
import urllib.parse


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.targets, self.ids, self.text = [], set(), []

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.ids.update(v for v in (values.get("id"), values.get("name")) if v)
        self.targets += [values[key] for key in ("href", "src") if values.get(key)]
        if tag == "meta" and values.get("name") == "viewport":
            self.text.append(f"viewport {values['content']}")


def read(page):
    links = Links()
    links.feed(page.read_text(encoding="utf-8"))
    return links


def broken_links(site):
    pages = {page: read(page) for page in site.rglob("*.html")}
    checked, broken = 0, []
    for page, links in pages.items():
        for target in links.targets:
            address = urllib.parse.urlsplit(target)
            if address.scheme or address.netloc:
                continue
            there = (page.parent / urllib.parse.unquote(address.path)).resolve() if address.path else page
            checked += 1
            if not there.exists():
                broken.append(f"{page.relative_to(site)}: no file for {target}")
            elif address.fragment and there in pages and urllib.parse.unquote(address.fragment) not in pages[there].ids:
                broken.append(f"{page.relative_to(site)}: no heading for {target}")
    return checked, broken


def expect(holds, text):
    if not holds:
        sys.exit(text)


def check_that_broken_links_are_found(folder):
    folder.mkdir(exist_ok=True)
    (folder / "a.html").write_text('<a href="b.html#x"></a><a href="c.html"></a><a href="b.html#y"></a><a href="https://x.y"></a>')
    (folder / "b.html").write_text('<p id="x"></p>')
    checked, broken = broken_links(folder)
    expect(checked == 3 and sorted(broken) == ["a.html: no file for c.html", "a.html: no heading for b.html#y"], f"{checked} {broken}")


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    site.parent.mkdir(parents=True, exist_ok=True)
    check_that_broken_links_are_found(site.with_name("docs-sample"))
    built = subprocess.run(["python3", *sys.argv[2:], "--out", site], capture_output=True, text=True)
    expect(built.returncode == 0, f"the site cannot be built:\n{built.stdout}{built.stderr}")
    expect(built.stderr == "", f"the build prints:\n{built.stderr}")
    checked, broken = broken_links(site)
    expect(not broken, "\n".join(broken))
    expect(checked > 2000, f"only {checked} links are found")

    index = json.loads(re.search(r"Search\.setIndex\((.*)\)", (site / "searchindex.js").read_text(encoding="utf-8"), re.DOTALL)[1])
    expect("concepts/steps" in index["docnames"] and "reference/case-file" in index["docnames"], "the search lacks pages")
    expect(any("load_world" in str(name) for name in index["objects"].values()), "the search lacks the API")
    for page, words in {
        "reference/commands": ["rigor diagnose", "--within", "RIGOR_PLUGINS"],
        "reference/metrics": ["position_error", "observed_order"],
        "reference/truths": ["heavy-top"],
        "reference/engines-and-methods": ["core:rk4", "orientation"],
        "reference/case-file": ["gravity", "rest_length", "at_least_order"],
        "reference/results": ["wall_seconds", "stable_dt"],
        "reference/protocol": ["wrenches"],
        "api/core-world": ["load_world", "read_scene_file", "A world at t = 0"],
        "api/adapters-plugin-rigor_engine": ["rigor_engine_v1", "struct_size"],
    }.items():
        text = re.sub(r"<[^>]*>", "", (site / f"{page}.html").read_text(encoding="utf-8"))
        for word in words:
            expect(word in text, f"{page} does not say {word}")
    print(f"{built.stdout.strip()}; {checked} internal links")


if __name__ == "__main__":
    main()
