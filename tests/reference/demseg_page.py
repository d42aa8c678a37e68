"""docs/demseg.md, the DEMseg tutorial page by page:  python -m tests.reference.demseg_page  writes its numbers anew.

Numbers come from the records of cases, from the table of validations, and from what is computed here in a moment.  All
else of the table is written in the page itself.
"""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from porescale.demseg.build import with_bodies
from porescale.demseg.deck import Deck, read_deck
from porescale.demseg.divide import divided
from porescale.demseg.trace import trace, unbalanced
from tests.reference import decks
from tests.reference.folders import CASES, ROOT

PAGE = ROOT / "docs" / "demseg.md"
BEGIN, END = "<!-- demseg -->\n", "<!-- end of demseg -->"
WHAT, HERE = 1, 3
"""Cells of a row: what the tutorial has, and the number of this program."""


def recorded(case: str, row: str, digits: int = 4) -> Callable[[], str]:
    """A number of the last recorded run of a case."""

    def found() -> str:
        numbers = json.loads((CASES / case / "recorded.json").read_text(encoding="utf-8"))["numbers"]
        return f"{numbers[row]:.{digits}g}"

    return found


def validated(name: str) -> Callable[[], str]:
    """What the tables of validations have measured in a row."""

    def found() -> str:
        text = (ROOT / "docs" / "evidence" / "dem.md").read_text(encoding="utf-8")
        line = next(line for line in text.splitlines() if line.startswith(f"| {name} |"))
        return line.split(" | ")[3].strip()

    return found


def mode_0(count: int) -> Deck:
    """So many random discs of radii 1 to 2 in a square, void ratio 0.5, thick 0.1."""
    side = math.sqrt(count * 1.5 * math.pi * 7.0 / 3.0)
    gm = f"0 0 0\n1d-6 0 0\n1\n2.5 1d8 .25d8 0 0 27\n0 {side} 0 {side} 0.1\n1 2\n1\n0.5\n"
    with TemporaryDirectory() as folder:
        return with_bodies(read_deck(decks.write(Path(folder), gm)), 0)


@cache
def parts(kind: str) -> tuple[int, int]:
    """Polygons of 304 random discs, and their sides."""
    made = divided(mode_0(304), kind).bodies
    return len(made), sum(len(body.segments) for body in made)


def spring(mass: float, stiffness: float) -> float:
    """sqrt(m/k)."""
    return math.sqrt(mass / stiffness)


DISC = 2.5 * math.pi * 4.0
BALL = 0.025 * math.pi
NUMBERS: dict[str, Callable[[], str]] = {
    "ex01-1, a disc: mass": recorded("demseg_disc", "mass"),
    "error of its energy over the fall, at the step of the deck, dt_cr/22": recorded(
        "demseg_disc", "err over the fall", 2
    ),
    "the same at dt_cr/10": lambda: f"{at_a_tenth():.2g}",
    "ex01-2, two discs in one body: mass of the union": recorded("demseg_clump", "mass"),
    "a segment; figure 6, energies add up: error over the fall": recorded("demseg_segment", "err over the fall", 2),
    "the same at a tenth of the step": recorded("demseg_segment", "the same at a tenth of the step", 2),
    "three segments make a triangle: mass of the inside": recorded("demseg_triangle", "mass"),
    "segment pushed with 1e4: x at step 10": recorded("demseg_control", "pushed: place x at step 10", 6),
    "x at step 20": recorded("demseg_control", "pushed: place x at step 20", 6),
    "its angle at step 20, rotation held": recorded("demseg_control", "moved: angle at the end", 6),
    "figure 9, soil pushes a block: it slides at this weight over that of limit equilibrium": recorded(
        "block_pushed_by_soil", "free block that goes 10 mm: weight over the critical one", 3
    ),
    "V = √(k/m) dx": lambda: f"{2.0 / spring(2.5 * math.pi * 1.21, 1e8):.1f}",
    "figure 10, speed of the pulse from No. 13 to 17": recorded("chain_pulse", "displacement, mean of both"),
    "figure 12, springs 100 times as soft: largest difference of vertical speeds": recorded(
        "rolling_on_a_slope", "difference of vertical speeds on the slope, of the largest", 2
    ),
    "critical dashpot, e = 0": lambda: f"{2e-4 * math.sqrt(1e8 * BALL):.4f}e4",
    "dashpot of e = 0.5": lambda: f"{2e-4 * math.sqrt(1e8 * BALL) * half():.4f}e4",
    "figure 14, height of the first bounce with that dashpot": recorded(
        "bouncing_disc", "the tutorial's c, ends without overlap: first height"
    ),
    "figure 16, longest step at h = 1/2, over √(m/k)": recorded("step_stability", "longest step, h = 0.5"),
    "dt_cr of ex01-1": lambda: f"{2e3 * spring(DISC, 1e8):.3f}e-3",
    "discs of radii 1 to 2 in 80 × 80, void ratio 0.5": recorded("demseg_repose", "discs"),
    "figure 19, angle of the slope; one packing is worth ± 1.9°": recorded("demseg_repose", "angle", 3),
    "it saturates: more at four times the friction": recorded(
        "angle_of_repose", "angle at four times the friction, more", 2
    ),
    "grains 8 times as large in an element test: largest difference of stress ratios": recorded(
        "grain_size", "largest difference of stress ratios, grains eight times as large", 2
    ),
    "in a short shear box: peak stress ratio, more": recorded("grain_size", "peak, short boxes less long", 2),
    "chain: tensions of in_cf0.dat": lambda: (
        f"{-float(recorded('demseg_chain', 'tensions of the first step', 8)()):.0f}"
    ),
    "pull at which it breaks, over k δ0": lambda: (
        f"{float(recorded('demseg_chain', 'pull that breaks it', 6)()) / 2e7:.4f}"
    ),
    "figure 24 (c), distance from the catenary, of the sag": recorded(
        "hanging_chain", "hanging: largest distance from the catenary, of the sag", 2
    ),
    "304 discs: stiffness, tensile, compressive strength over the naive ones": validated("dem.rock_of_discs"),
    "compressive over tensile strength": validated("dem.rock_of_discs_is_weak_when_pressed"),
    "triangles, and their segments, of 304 discs": lambda: ", ".join(map(str, parts("triangles"))),
    "Voronoi cells": lambda: str(parts("cells")[0]),
    "triangles, every segment for itself: contacts over those of discs, stiffness over k": validated(
        "dem.rock_of_triangles_that_count_each"
    ),
    "compressive over tensile strength, corners once, one packing of 80 discs, tan 27°: triangles, cells": validated(
        "dem.rock_of_polygons_is_strong_when_pressed"
    ),
    "the same of triangles of two packings of 152 discs": recorded("rock", "triangles: compressive over tensile", 2),
}
"""The number of this program, by what the tutorial has; rows that have words in its place are not here."""


@cache
def at_a_tenth() -> float:
    """Error of the energy of ex01-1 over the fall at a tenth of the tutorial's dt_cr, in the steps of the deck."""
    folder = CASES / "demseg_disc"
    return unbalanced(trace(folder, replace(read_deck(folder), dt=1.123e-4)))


def half() -> float:
    """h of e = 0.5."""
    return math.log(2.0) / math.hypot(math.pi, math.log(2.0))


def rows(text: str) -> list[list[str]]:
    """The cells of each row of the page's table: section, what it has, what it prints, the number here, command."""
    table = text.partition(BEGIN)[2].partition(END)[0].splitlines()
    return [line.removeprefix("| ").removesuffix(" |").split(" | ") for line in table[2:]]


def with_numbers(text: str) -> str:
    """The page with the numbers of today."""
    for row in rows(text):
        if row[WHAT] in NUMBERS:
            new = [*row[:HERE], NUMBERS[row[WHAT]](), *row[HERE + 1 :]]
            text = text.replace(f"| {' | '.join(row)} |\n", f"| {' | '.join(new)} |\n")
    return text


if __name__ == "__main__":
    PAGE.write_text(with_numbers(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
