#!/usr/bin/env python3
"""Checks what a release needs; .github/RELEASE.md explains each point. Exits with 1 if a point does not hold.

  cases/setup release release                              builds everything, the site and the package, then checks
  .ci/release.py --build build/release --version 1.0.0     checks only
"""
import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def changelog_faults(text, version):
    """The newest section is of this version, has a date and entries, and nothing is left unreleased."""
    heads = list(re.finditer(r"^## (.*)$", text, flags=re.MULTILINE))
    bodies = [text[head.end():next_head.start() if next_head else None] for head, next_head in zip(heads, [*heads[1:], None])]
    titles = [head[1] for head in heads]
    if titles[:1] != ["Unreleased"]:
        return ["CHANGELOG.md: the first section is not `## Unreleased`"]
    faults = []
    if re.search(r"^- ", bodies[0], flags=re.MULTILINE):
        faults.append("CHANGELOG.md: `## Unreleased` still has entries; move them to the new version")
    newest = re.fullmatch(r"(\S+) - (\d{4}-\d\d-\d\d)", titles[1]) if len(titles) > 1 else None
    if not newest or newest[1] != version:
        faults.append(f"CHANGELOG.md: the newest version is not `## {version} - DATE`")
    elif not re.search(r"^- ", bodies[1], flags=re.MULTILINE):
        faults.append(f"CHANGELOG.md: version {version} has no entries")
    return faults


def changelog_date(text, version):
    date = re.search(rf"^## {re.escape(version)} - (\S+)$", text, flags=re.MULTILINE)
    return date[1] if date else None


def citation_faults(text, version, date):
    faults = []
    for key, value in (("version", version), ("date-released", date)):
        found = re.search(rf'^{key}: "?([^"\n]*)"?$', text, flags=re.MULTILINE)
        if not found or found[1] != value:
            faults.append(f"CITATION.cff: {key} is {found[1] if found else 'missing'}, not {value}")
    return faults


def said(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def tree_faults(root, version):
    changed = said("git", "-C", root, "status", "--porcelain").splitlines()
    faults = [f"the tree has {len(changed)} uncommitted changes, for example {changed[0][3:]}"] if changed else []
    head, tagged = (said("git", "-C", root, "rev-parse", "--verify", "-q", f"{name}^{{commit}}") for name in ("HEAD", f"v{version}"))
    if tagged and tagged != head:
        faults.append(f"the tag v{version} is on another commit")
    return faults


def program_faults(build, root, version):
    lines = said(build / "rigor", "--version").splitlines() + ["", ""]
    faults = [] if lines[0] == f"rigor {version}" else [f"the program says `{lines[0]}`, not `rigor {version}`; build it again"]
    built_from = said("git", "-C", root, "describe", "--always", "--dirty", "--abbrev=10").strip()
    if lines[1] != f"commit {built_from}":
        faults.append(f"the program is built from `{lines[1]}`, the tree is `commit {built_from}`; build it again")
    return faults


def test_faults(build, root):
    """Every test file is a suite of ctest: none is left out because an engine or a tool is missing."""
    listed = set(re.findall(r"Test +#\d+: (\S+)", said("ctest", "--test-dir", build, "-N")))
    tests = root / "tests"
    wanted = {path.relative_to(tests).as_posix().removesuffix("_test.cpp").replace("/", "_") for path in tests.rglob("*_test.cpp")}
    missing = sorted((wanted | {"package", "docs", "release"}) - listed)
    return [f"{len(missing)} suites are not in the build, for example {missing[0]}; build with RIGOR_ENGINES=all"] if missing else []


def product_faults(build, version):
    faults = [] if (build / "docs/index.html").exists() else ["there is no documentation site; cases/setup release docs"]
    packages = sorted(build.glob(f"rigor_{version}*.deb"))
    if not packages:
        faults.append(f"there is no package rigor_{version}; cases/setup release deb")
    elif said("dpkg-deb", "--field", packages[0], "Version").strip() != version:
        faults.append(f"{packages[0].name} is of another version")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=pathlib.Path)
    parser.add_argument("--version", required=True)
    args = parser.parse_args()
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    points = {
        "tree and tag": tree_faults(ROOT, args.version),
        "CHANGELOG.md": changelog_faults(changelog, args.version),
        "CITATION.cff": citation_faults(citation, args.version, changelog_date(changelog, args.version)),
        "program": program_faults(args.build, ROOT, args.version),
        "tests": test_faults(args.build, ROOT),
        "site and package": product_faults(args.build, args.version),
    }
    for name, faults in points.items():
        print(f"{'FAIL' if faults else 'ok':5} {name}")
        for fault in faults:
            print(f"      {fault}")
    if any(points.values()):
        sys.exit(1)
    print(f"Rigor {args.version} can be tagged: git tag v{args.version}")


if __name__ == "__main__":
    main()
