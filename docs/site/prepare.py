# SPDX-License-Identifier: BSD-3-Clause
"""Gathers what Sphinx makes the site of: prepare.py REPOSITORY XML PAGES ROOM...

PAGES gets copies of the repository's pages, pictures and what they link to, in the same places, and api/ROOM.rst for each
room, with a section for each public header. XML is what Doxygen wrote; members of namespaces are moved to their headers there,
since breathe shows a header's own members only."""
import shutil
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

WANTED = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "bench/*.md", "docs/*.*", "docs/api/*", "docs/how-to/*",
          "docs/pictures/*", "examples/**/*", "cmake/*.cmake"]
NOT_SHOWN = ("private",)


def gather(repository, pages):
    """Copies files that differ, with their times, and removes what is no longer there."""
    wanted = {}
    for pattern in WANTED:
        for path in repository.glob(pattern):
            if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".in":
                wanted[path.relative_to(repository)] = path
    for old in [path for path in pages.rglob("*") if path.is_file()]:
        name = old.relative_to(pages)
        if name not in wanted and name.parts[0] != "api":
            old.unlink()
    for name, path in wanted.items():
        target = pages / name
        if not target.exists() or target.stat().st_mtime != path.stat().st_mtime:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, target)


def headers_of(xml):
    """By path: the XML file of each header, its tree, and its compound."""
    headers = {}
    for path in xml.glob("*_8h.xml"):
        tree = ElementTree.parse(path)
        compound = tree.getroot().find("compounddef")
        headers[compound.find("location").get("file")] = path, tree, compound
    return headers


def move_members(xml, headers):
    """Functions, types and constants of namespaces go to the headers that declare them, with qualified names."""
    for path in sorted(xml.glob("namespace*.xml")):
        namespace = ElementTree.parse(path).getroot().find("compounddef")
        for section in namespace.findall("sectiondef"):
            for member in section.findall("memberdef"):
                compound = headers[member.find("location").get("file")][2]
                if compound.get("moved"):
                    continue
                kind = section.get("kind")
                place = next((each for each in compound.findall("sectiondef") if each.get("kind") == kind), None)
                if place is None:
                    place = ElementTree.SubElement(compound, "sectiondef", kind=kind)
                name = member.find("name")
                name.text = f"{namespace.findtext('compoundname')}::{name.text}"
                place.append(member)
    for path, tree, compound in headers.values():
        compound.set("moved", "yes")
        for name in ("innernamespace", "incdepgraph", "invincdepgraph", "includes", "includedby"):
            for each in compound.findall(name):
                compound.remove(each)
        tree.write(path, encoding="utf-8", xml_declaration=True)


def simplify(xml):
    """Inner classes that are private go; so do default values that are functions, which Sphinx cannot read."""
    for path in [*xml.glob("class*.xml"), *xml.glob("struct*.xml")]:
        tree = ElementTree.parse(path)
        for compound in tree.getroot().findall("compounddef"):
            for inner in [each for each in compound.findall("innerclass") if each.get("prot") in NOT_SHOWN]:
                compound.remove(inner)
            for member in compound.iter("memberdef"):
                value = member.find("initializer")
                if value is not None and "](" in "".join(value.itertext()):
                    member.remove(value)
        tree.write(path, encoding="utf-8", xml_declaration=True)


def write_if_new(path, text):
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def titled(text, line):
    return f"{text}\n{line * len(text)}\n\n"


def write_rooms(repository, pages, rooms, headers):
    for room in rooms:
        include = repository / room / "include"
        names = sorted(str(path.relative_to(include)) for path in include.rglob("*.h"))
        text = titled(f"C++: {room}", "=")
        text += f"Public headers of the library ``Slabhull::{room}``, by :doc:`room </docs/architecture>`.\n\n"
        text += ".. contents::\n   :local:\n\n"
        for name in names:
            text += titled(name, "-")
            if name in headers and (headers[name][2].find("sectiondef") is not None or
                                    headers[name][2].find("innerclass") is not None):
                text += f".. doxygenfile:: {name}\n   :sections: briefdescription detaileddescription innerclass define "
                text += "enum func typedef var public-attrib public-func public-static-attrib public-static-func "
                text += "public-type\n\n"
            else:
                text += "Includes others; declares nothing itself.\n\n"
        write_if_new(pages / "api" / f"{room}.rst", text)


def main():
    repository, xml, pages = map(Path, sys.argv[1:4])
    headers = headers_of(xml)
    move_members(xml, headers)
    simplify(xml)
    gather(repository, pages)
    write_rooms(repository, pages, sys.argv[4:], headers)


if __name__ == "__main__":
    main()
