# SPDX-License-Identifier: BSD-3-Clause
"""The exceptions of slabhull. Their text says what went wrong, where, and what to do."""
from typing import NamedTuple, Sequence


class Entity(NamedTuple):
    """A thing at fault, by its number in the caller's arrays or file; `where` is its patch, "" for none."""

    kind: str
    number: int
    where: str


class Error(Exception):
    """Refused work; `entities` lists what is at fault."""

    def __init__(self, message: str = "", entities: Sequence[Entity] = ()):
        super().__init__(message)
        self.entities = list(entities)


class UsageError(Error, ValueError):
    """Wrong arguments or a wrong case."""


class InputError(Error):
    """A file or a domain is invalid."""


class GeometryError(Error):
    """The geometry or the meshing failed."""


class TangledBoundary(GeometryError):
    """The motion makes the boundary cross itself: it is sound until `good_until` and tangled at `tangled_at`."""

    def __init__(self, message: str = "", entities: Sequence[Entity] = (), good_until: float = float("nan"),
                 tangled_at: float = float("nan")):
        super().__init__(message, entities)
        self.good_until = good_until
        self.tangled_at = tangled_at


class TooManyLayers(GeometryError):
    """A motion needs more layers than allowed."""


class LimitError(GeometryError):
    """A count does not fit the index type."""


class OutputError(Error):
    """Writing failed; what was there before is untouched."""


class FormatLimit(OutputError):
    """A file format cannot hold what is to be written."""


class Interrupted(Error):
    """The progress function returned False. (Ctrl-C is a KeyboardInterrupt.)"""
