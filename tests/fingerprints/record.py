"""The record: recorded.json, a line for each name.

{"processor": …, "fingerprints": {name: {"1": hash on one thread, "2": on two, "steps": n, "seconds": s, "parts": …,
"libraries": {…}}}}, seconds of one thread; parts are short hashes that say where a difference lies; libraries are the
versions of those whose last bits may differ from version to version, as OpenCV's do, where they were noted.
"""

import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

RECORD = Path(__file__).with_name("recorded.json")
LIBRARIES = ("numpy", "scipy", "numba", "llvmlite", "opencv-python-headless")
SHOWN = 6
"""Parts that are named where more differ."""


def read(path: Path = RECORD) -> dict[str, Any]:
    """The record, or an empty one."""
    if not path.exists():
        return {"processor": None, "fingerprints": {}}
    known: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return known


def failure(found: dict[str, Any]) -> str:
    """What went wrong on some number of threads, "" if nothing did."""
    return next((f"fails on {count} threads: {it['error']}" for count, it in found.items() if "error" in it), "")


def libraries() -> dict[str, str]:
    """The version of each of LIBRARIES."""
    return {name: version(name) for name in LIBRARIES}


def other_libraries(known: dict[str, Any]) -> str:
    """Which libraries were others when ``known`` was recorded, for the end of a line; "" if none or not noted."""
    now = libraries()
    then = [f"{name} {it}" for name, it in known.get("libraries", {}).items() if now.get(name) != it]
    return f"; recorded with {', '.join(then)}" if then else ""


def kept(name: str, found: dict[str, Any], processor: str, path: Path) -> str:
    """Write what was found of a name into the record at once; says so."""
    wrong = failure(found)
    if wrong:
        return wrong
    known = read(path)
    first = next(iter(found.values()))
    row = {count: it["hash"] for count, it in found.items()}
    row |= {"steps": first["steps"], "seconds": first["seconds"], "parts": first["parts"], "libraries": libraries()}
    known["fingerprints"][name] = row
    rows = (f"{json.dumps(key)}: {json.dumps(it)}" for key, it in sorted(known["fingerprints"].items()))
    lines = ",\n".join(rows)
    path.write_text(f'{{"processor": {json.dumps(processor)}, "fingerprints": {{\n{lines}\n}}}}\n', encoding="utf-8")
    alike = "" if len({it["hash"] for it in found.values()}) == 1 else ", DIFFERS by threads"
    times = " + ".join(f"{it['seconds']:.1f}" for it in found.values())
    return f"written: {first['steps']} steps, {times} s{alike}"


def compared(known: dict[str, Any], found: dict[str, Any]) -> str:
    """Whether what was found of a name is what was recorded, and if not, in which parts it differs."""
    wrong = failure(found)
    if wrong:
        return wrong
    off = [count for count, it in found.items() if it["hash"] != known.get(count)]
    if not off:
        return f"same ({sum(it['seconds'] for it in found.values()):.1f} s)"
    now, then = found[off[0]]["parts"], known["parts"]
    parts = [part for part in sorted({*now, *then}) if now.get(part) != then.get(part)]
    more = f" and {len(parts) - SHOWN} more" if len(parts) > SHOWN else ""
    return f"DIFFERS on {' and '.join(off)} threads: {', '.join(parts[:SHOWN])}{more}{other_libraries(known)}"
