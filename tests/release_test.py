#!/usr/bin/env python3
"""Tests the checks of a release (.ci/release.py), and that the version of this tree is the same everywhere.

  tests/release_test.py VERSION FOLDER       FOLDER is emptied and used for samples
"""
import importlib.util
import pathlib
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True  # the sources stay as they are
ROOT = pathlib.Path(__file__).resolve().parent.parent
spec = importlib.util.spec_from_file_location("release", ROOT / ".ci/release.py")
release = importlib.util.module_from_spec(spec)
spec.loader.exec_module(release)

GOOD = "# Changelog\n\n## Unreleased\n\n## 2.0.0 - 2026-12-01\n\n### Added\n- A thing.\n\n## 1.0.0 - 2026-11-24\n- Old.\n"


def expect(faults, *words):
    assert len(faults) == len(words), faults
    for fault, word in zip(faults, words):
        assert word in fault, (fault, word)


def test_changelog():
    expect(release.changelog_faults(GOOD, "2.0.0"))
    expect(release.changelog_faults(GOOD, "2.1.0"), "not `## 2.1.0 - DATE`")
    expect(release.changelog_faults(GOOD.replace("## Unreleased\n", "## Unreleased\n- New.\n"), "2.0.0"), "still has entries")
    expect(release.changelog_faults(GOOD.replace("- A thing.", ""), "2.0.0"), "no entries")
    expect(release.changelog_faults(GOOD.replace("2026-12-01", "soon"), "2.0.0"), "not `## 2.0.0 - DATE`")
    expect(release.changelog_faults(GOOD.replace("## Unreleased\n", ""), "2.0.0"), "first section")
    assert release.changelog_date(GOOD, "2.0.0") == "2026-12-01"


def test_citation():
    text = 'version: 2.0.0\ndate-released: "2026-12-01"\n'
    expect(release.citation_faults(text, "2.0.0", "2026-12-01"))
    expect(release.citation_faults(text, "2.0.1", "2026-12-02"), "version is 2.0.0", "date-released is 2026-12-01")
    expect(release.citation_faults("version: 2.0.0\n", "2.0.0", "2026-12-01"), "date-released is missing")


def test_tree_program_and_products(folder):
    def git(*words):
        subprocess.run(["git", "-C", tree, "-c", "user.name=A", "-c", "user.email=a@b.c", *words], check=True, capture_output=True)

    tree, build = folder / "tree", folder / "build"
    (tree / "tests/core").mkdir(parents=True), build.mkdir()
    (tree / "file").write_text("1")
    git("init", "-q"), git("add", "-A"), git("commit", "-q", "-m", "First")
    expect(release.tree_faults(tree, "2.0.0"))
    git("tag", "v2.0.0")
    (tree / "file").write_text("2")
    expect(release.tree_faults(tree, "2.0.0"), "1 uncommitted changes, for example file")
    git("commit", "-q", "-a", "-m", "Second")
    expect(release.tree_faults(tree, "2.0.0"), "v2.0.0 is on another commit")

    program = build / "rigor"
    program.write_text("#!/bin/sh\necho rigor 1.9.0; echo commit abc-dirty\n")
    program.chmod(0o755)
    expect(release.program_faults(build, tree, "2.0.0"), "says `rigor 1.9.0`", "built from `commit abc-dirty`")
    expect(release.product_faults(build, "2.0.0"), "no documentation site", "no package rigor_2.0.0")
    (tree / "tests/core/lost_test.cpp").write_text("")
    expect(release.test_faults(build, tree), "4 suites are not in the build, for example core_lost")


def test_this_tree(version):
    """Between releases CHANGELOG.md may have unreleased entries. The newest version is always that of CMakeLists.txt."""
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    date = release.changelog_date(changelog, version)
    assert date, f"CHANGELOG.md has no `## {version} - DATE`"
    expect(release.citation_faults((ROOT / "CITATION.cff").read_text(encoding="utf-8"), version, date))


def main():
    version, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    test_changelog()
    test_citation()
    test_tree_program_and_products(folder)
    test_this_tree(version)


if __name__ == "__main__":
    main()
