# SPDX-License-Identifier: BSD-3-Clause
"""The stub file says what the module has: names, members, arguments; and everything has a docstring."""
import ast
import inspect
import re
from pathlib import Path

import harness
import slabhull
from slabhull import _slabhull


def public(names):
    return {name for name in names if not name.startswith("_")}


def arguments_of(documented):
    """The names of the arguments in pybind11's first line of a docstring; kwargs as **."""
    inside = re.match(r"\w+\((.*)\) ->", documented.split("\n")[0]).group(1)
    depth, parts, part = 0, [], ""
    for letter in inside + ",":
        depth += letter in "[{("
        depth -= letter in "]})"
        if letter == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += letter
    names = [each.split(":")[0].split("=")[0].strip() for each in parts if each and each != "*"]
    return ["**" if name.startswith("**") else name for name in names]


def arguments_in(node):
    names = [each.arg for each in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
    return names + (["**"] if node.args.kwarg else [])


class Stubs(harness.PythonTest):
    @classmethod
    def setUpClass(cls):
        path = Path(slabhull.__file__).with_name("_slabhull.pyi")
        cls.body = ast.parse(path.read_text()).body

    def test_the_names_are_those_of_the_module(self):
        stubbed = {node.name for node in self.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(public(stubbed), public(vars(_slabhull)))

    def test_the_members_and_arguments_are_those_of_the_classes(self):
        for node in self.body:
            if isinstance(node, ast.ClassDef):
                with self.subTest(node.name):
                    self.compare_class(node, getattr(_slabhull, node.name))

    def compare_class(self, node, real):
        functions = {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}
        attributes = {each.target.id for each in node.body if isinstance(each, ast.AnnAssign)}
        self.assertEqual(public(functions) | attributes, public(vars(real)))
        for name, function in functions.items():
            member = inspect.getattr_static(real, name)
            is_property = any(isinstance(each, ast.Name) and each.id == "property" for each in function.decorator_list)
            self.assertEqual(isinstance(member, property), is_property, name)
            if not is_property and name not in ("to_meshio", "to_vtk"):
                documented = getattr(real, name).__doc__
                self.assertEqual(arguments_in(function), arguments_of(documented), name)

    def test_the_arguments_of_functions(self):
        for node in self.body:
            if isinstance(node, ast.FunctionDef):
                with self.subTest(node.name):
                    self.assertEqual(arguments_in(node), arguments_of(getattr(_slabhull, node.name).__doc__))

    def test_all_that_is_public_is_there_and_documented(self):
        for name in slabhull.__all__:
            with self.subTest(name):
                self.assertTrue((getattr(slabhull, name).__doc__ or "").strip())
        self.assertTrue(Path(slabhull.__file__).with_name("py.typed").exists())


if __name__ == "__main__":
    harness.main()
