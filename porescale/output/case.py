"""Cases that are scripts: what they measured against expected.toml, on the screen, and a picture of it.

A row of expected.toml holds name, value, tolerance, unit and because; the script gives a number for every name.
"""

import argparse
import io
import math
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from porescale.common.core.atomic import whole

COLOURS = 128


def expected(folder: Path) -> list[dict[str, Any]]:
    """The rows of ``folder``/expected.toml."""
    rows: list[dict[str, Any]] = tomllib.loads((folder / "expected.toml").read_text(encoding="utf-8-sig"))["expected"]
    return rows


def missed(folder: Path, numbers: Mapping[str, float | None]) -> list[str]:
    """Names of the rows of ``folder``/expected.toml that ``numbers`` lie outside of; a number that is none is outside.

    None: the options left it out.  Raises KeyError at a row without a number.
    """
    given = [(row, numbers[row["name"]]) for row in expected(folder)]
    return [row["name"] for row, it in given if it is not None and not abs(it - row["value"]) <= row["tolerance"]]


Option = tuple[Callable[[str], Any], Any, str] | tuple[Callable[[str], Any], Any, str, float]
"""Type, or function that reads a text and raises ValueError, default, help and, of a number, the least allowed."""


def options(description: str, folder: Path, **more: Option) -> argparse.Namespace:
    """The options of a script in ``folder``: --out, and those in ``more``; of type bool is a flag.

    Ends the program with exit code 2 at what is no option, at a number below its least, and at one that is not finite.
    """
    parser = argparse.ArgumentParser(description=description.partition("\n")[0])
    default = Path("runs") / folder.name
    parser.add_argument("--out", type=Path, default=default, help=f"folder of the picture (default: {default})")
    for name, (kind, value, text, *_) in more.items():
        if kind is bool:
            parser.add_argument(f"--{name}", action="store_true", help=text)
        else:
            parser.add_argument(f"--{name}", type=kind, default=value, help=f"{text} (default: {value})")
    asked = parser.parse_args()
    for name, (kind, _, _, *least) in more.items():
        given = getattr(asked, name)
        if kind is float and not math.isfinite(given):
            parser.error(f"--{name} = {given}: is not finite")
        if least and given < least[0]:
            parser.error(f"--{name} = {given}: is out of range (allowed: {least[0]:g} or more)")
    return asked


def stage(columns: int, width: float = 9.0, height: float = 3.4) -> tuple[Figure, list[Axes]]:
    """A figure of ``columns`` axes side by side, ``width`` by ``height`` inches."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, list(figure.subplots(1, columns, squeeze=False)[0])


def draw(figure: Figure, picture: Path) -> None:
    """Write ``figure`` as a PNG of 128 colours, a third of the bytes: cases lie in the repository with them."""
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=100)
    few = Image.open(drawn).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    with whole(picture) as beside:
        few.save(beside, format="png", optimize=True)


def conclude(
    folder: Path, numbers: Mapping[str, float | None], figure: Figure, out: Path, say: Callable[[str], object] = print
) -> int:
    """Print every row with what was measured, write ``out``/picture.png; the exit code: 1 if a row is missed."""
    off = missed(folder, numbers)
    for row in expected(folder):
        word, value = "MISSED" if row["name"] in off else "ok", numbers[row["name"]]
        if value is None:
            say(f"none    {row['name']}: these options do not measure it")
            continue
        number = f"{value:.5g}, expected {row['value']:g} ± {row['tolerance']:g} {row['unit']}"
        say(f"{word:6}  {row['name']}: {number.rstrip()}")
    out.mkdir(parents=True, exist_ok=True)
    picture = out / "picture.png"
    draw(figure, picture)
    say(f"picture: {picture}")
    return 1 if off else 0
