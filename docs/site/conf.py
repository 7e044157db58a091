# SPDX-License-Identifier: BSD-3-Clause
"""Settings of Sphinx for the documentation site. The target `site` runs it on the pages that prepare.py gathered."""
import os
import re

import sphinx.domains.cpp
import sphinx.util.logging

project = "Slabhull"
author = "The Slabhull authors"
project_copyright = "2026, the Slabhull authors"
version = release = os.environ["SLABHULL_VERSION"]

extensions = ["breathe", "myst_parser", "sphinx.ext.autodoc"]
root_doc = "docs/index"
default_role = "code"
myst_heading_anchors = 4  # as GitHub makes them
myst_enable_extensions = ["tasklist"]
suppress_warnings = ["myst.header"]

breathe_projects = {"slabhull": os.environ["SLABHULL_XML"]}
breathe_default_project = "slabhull"
breathe_show_include = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "undoc-members": False}
add_module_names = False

html_theme = "sphinx_rtd_theme"
html_title = f"Slabhull {release}"
html_static_path = [os.path.join(os.path.dirname(os.path.abspath(__file__)), "style.css")]
html_css_files = ["style.css"]
html_theme_options = {"navigation_depth": 3, "prev_next_buttons_location": "bottom"}
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False

log = sphinx.util.logging.getLogger("slabhull")


def remember_ids():
    """Sphinx 5 makes the id of each overload anew at each look-up, which is two thirds of the time of all pages."""
    declaration = sphinx.domains.cpp.ASTDeclaration
    make = declaration.get_newest_id

    def remembered(self):
        if "remembered_id" not in self.__dict__:
            self.remembered_id = make(self)
        return self.remembered_id

    declaration.get_newest_id = remembered


def public_names(app, what, name, obj, options, signature, returns):
    """Signatures say slabhull.Motion, not the extension module behind it."""
    def shown(text):
        return text and re.sub(r"\(self: [\w.]+(, )?", "(", text).replace("slabhull._slabhull.", "")
    return shown(signature), shown(returns)


def without_signature(app, what, name, obj, options, lines):
    """pybind11 writes the signature as the first line of a docstring, too."""
    short = name.rsplit(".", 1)[-1]
    if lines and what in ("method", "function") and lines[0].startswith(f"{short}("):
        del lines[0]


def all_names_are_there(app, env):
    """Each public name of the Python module must be on a page."""
    import slabhull
    there = env.get_domain("py").objects
    for name in slabhull.__all__:
        if f"slabhull.{name}" not in there:
            log.warning("slabhull.%s is on no page: add it to docs/api/python.rst", name)


def setup(app):
    remember_ids()
    app.connect("autodoc-process-signature", public_names)
    app.connect("autodoc-process-docstring", without_signature)
    app.connect("env-check-consistency", all_names_are_there)
