# SPDX-License-Identifier: BSD-3-Clause
"""The fenced blocks of a page in Markdown, with what HTML comments before them say about them."""
import re
from dataclasses import dataclass, field

MARKERS = ("file", "in", "instead", "not run", "needs", "exit", "output", "page not run")
FENCE = re.compile(r"^( {0,3})(`{3,}|~{3,})\s*(\S*)\s*$")


class PageError(Exception):
    """A page that cannot be read as pages are written."""


@dataclass
class Block:
    line: int  # of its first line of code, from 1
    language: str
    text: str
    markers: dict = field(default_factory=dict)


def marker_of(comment, line):
    """(name, value) of a comment that is a marker, else None. Comments that look like one and are none are refused."""
    name, colon, value = comment.partition(":")
    name, value = name.strip(), value.strip()
    if name not in MARKERS:
        if re.fullmatch(r"[a-z ]{1,16}", name) and colon:
            raise PageError(f"line {line}: there is no marker \"{name}\"; there are {', '.join(MARKERS)}, \"first, python\" and \"first, sh\"")
        return None
    if name != "output" and not value:
        raise PageError(f"line {line}: the marker \"{name}\" says nothing")
    return name, value


def read_blocks(text):
    """(blocks, why the whole page is not run or None). Code that a reader could take for a command, but which has no language,
    is refused: blocks that are indented, and fences that say none."""
    blocks, markers, why_not = [], {}, None
    lines = text.split("\n")
    k, in_list, blank = 0, False, True
    while k < len(lines):
        line = lines[k]
        if line.lstrip().startswith("<!--"):
            begin = k
            while "-->" not in lines[k]:
                k += 1
                if k == len(lines):
                    raise PageError(f"line {begin + 1}: a comment without an end")
            comment = "\n".join(lines[begin:k + 1]).strip()[4:].split("-->")[0]
            first = re.match(r"\s*first, (python|sh):", comment)
            if first:
                blocks.append(Block(begin + 2, first[1], comment[first.end():].strip("\n"), {"hidden": "yes"}))
            else:
                marker = marker_of(comment, begin + 1)
                if marker is not None and marker[0] == "page not run":
                    why_not = marker[1]
                elif marker is not None:
                    markers[marker[0]] = marker[1]
            k += 1
            continue
        fence = FENCE.match(line)
        if fence:
            begin = k
            end = re.compile(rf"^ {{0,3}}{fence[2][0]}{{{len(fence[2])},}}\s*$")
            k += 1
            while k < len(lines) and not end.match(lines[k]):
                k += 1
            if k == len(lines):
                raise PageError(f"line {begin + 1}: a block without an end")
            if not fence[3]:
                raise PageError(f"line {begin + 1}: a block without a language")
            if not fence[3].startswith("{"):
                indent = len(fence[1])
                code = "\n".join(each[indent:] if each[:indent].isspace() else each for each in lines[begin + 1:k])
                blocks.append(Block(begin + 2, fence[3], code, markers))
            markers = {}
            k += 1
            blank = True
            continue
        if line.strip():
            if blank and not in_list and line.startswith("    "):
                raise PageError(f"line {k + 1}: a block that is indented; put it between fences, with its language")
            if not line.startswith(" "):
                in_list = bool(re.match(r"([-*+]|\d+\.)\s", line))
                if markers:
                    raise PageError(f"line {k + 1}: a marker with no block after it: {', '.join(markers)}")
        blank = not line.strip()
        k += 1
    if markers:
        raise PageError(f"a marker with no block after it: {', '.join(markers)}")
    return blocks, why_not
