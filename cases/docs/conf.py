"""Settings of Sphinx for the documentation site. build.py passes what depends on the build through the environment."""
import logging
import os

project = "Rigor"
version = release = os.environ["RIGOR_DOCS_VERSION"]
author = "The authors of Rigor"
extensions = ["myst_parser", "breathe"]
root_doc = "index"
html_theme = "furo"
html_title = f"Rigor {release}"
html_show_copyright = False
html_copy_source = False
html_static_path = ["_static"]
html_css_files = ["narrow.css"]
myst_heading_anchors = 4
breathe_projects = {"rigor": os.environ["RIGOR_DOCS_XML"]}
breathe_default_project = "rigor"
breathe_default_members = ("members",)
highlight_language = "none"
# The lexer for awk does not know every form of a regular expression. Such code is shown without colours.
suppress_warnings = ["misc.highlighting_failure"]


class NamespaceAgain(logging.Filter):
    """Each header opens the namespace again; Breathe then declares it once a page, which is no mistake."""

    def filter(self, record):
        return "Declaration is '.. cpp:type:: rigor'." not in record.getMessage()


logging.getLogger("sphinx.sphinx.domains.cpp").addFilter(NamespaceAgain())
