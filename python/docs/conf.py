"""Settings of Sphinx for the reference (scripts/python_docs)."""

from __future__ import annotations

import microtrace

project = "microtrace"
release = version = microtrace.__version__
extensions = ["sphinx.ext.autodoc", "sphinx.ext.napoleon", "myst_parser"]
html_theme = "alabaster"
html_show_copyright = False

autodoc_class_signature = "separated"
autodoc_default_options = {"members": True, "inherited-members": True, "member-order": "bysource"}
autodoc_typehints = "signature"
autodoc_type_aliases = {"npt.ArrayLike": "ArrayLike", "Camera": "Camera", "Quantity": "Quantity"}
autodoc_preserve_defaults = True
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_custom_sections = [("Warns", "Warns")]
