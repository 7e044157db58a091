# SPDX-License-Identifier: BSD-3-Clause
"""What a check found."""
import json
from dataclasses import dataclass
from typing import Any, Dict, List, NamedTuple

from .errors import Entity


class Finding(NamedTuple):
    """A defect: its stable name such as "open-facet", what is at fault, and a line for the user."""

    what: str
    entities: List[Entity]
    text: str


@dataclass(frozen=True)
class Report:
    """`values` has the keys of `slabhull check --json`; `findings` at most twenty of each kind; `total` counts all."""

    values: Dict[str, Any]
    findings: List[Finding]
    skipped: List[str]
    total: int
    text: str

    @property
    def clean(self) -> bool:
        """Whether nothing was found."""
        return self.total == 0

    def __str__(self) -> str:
        return self.text + ("nothing found" if self.clean else f"{self.total} finding{'s' * (self.total > 1)}")


def report_of(told) -> Report:
    """A Report of what the extension module tells."""
    values, embedding, findings, skipped, total, text = told
    values = json.loads(values)
    if embedding:
        values["embedding"] = json.loads(embedding)
    return Report(values, [Finding(*finding) for finding in findings], skipped, total, text)
