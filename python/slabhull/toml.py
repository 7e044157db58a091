# SPDX-License-Identifier: BSD-3-Clause
"""Case files from dicts."""
import json
import math
import os
from typing import Any, Mapping

from .errors import UsageError


def as_toml(tables: Mapping[str, Any]) -> str:
    """The text of a TOML file. Values may be numpy's, and paths."""
    lines = []
    _write_table(lines, (), tables)
    return "".join(line + "\n" for line in lines)


def _write_table(lines, name, table):
    """The plain keys first, then the tables inside."""
    if name:
        lines.append(f"[{'.'.join(map(_text, name))}]")
    for key, value in table.items():
        if not isinstance(value, Mapping) and value is not None:
            lines.append(f"{_text(key)} = {_value((*name, key), value)}")
    for key, value in table.items():
        if isinstance(value, Mapping):
            _write_table(lines, (*name, key), value)


def _text(text):
    return json.dumps(str(text), ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(name, value):
    if hasattr(value, "tolist"):  # numpy's arrays and numbers
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, (str, os.PathLike)):
        return _text(os.fspath(value))
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(name, each) for each in value) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_text(key)} = {_value(name, each)}" for key, each in value.items()) + "}"
    raise UsageError(f"{'.'.join(map(str, name))}: a {type(value).__name__} is nothing that a case file can say")
