"""docs/demseg.md, the DEMseg tutorial page by page:  python -m tests.reference.demseg_page  writes its table anew.

Numbers come from the records of cases, from the table of validations, and from what is computed here in a moment.
"""

import json
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
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
HEAD = "| section | in the tutorial | there | here | command |\n|---|---|---|---|---|\n"


@dataclass(frozen=True)
class Row:
    """section of the tutorial;  what : it has;  printed : what it prints, or a dash;  here : the number, or words, of
    this program;  command : that shows it."""

    section: str
    what: str
    printed: str
    here: Callable[[], str]
    command: str


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


def said(text: str) -> Callable[[], str]:
    """Words."""
    return lambda: text


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
RUN, VERIFY = "porescale demseg run", "porescale verify"
ROWS = (
    Row("I-2-1", "ex01-1, a disc: mass", "–", recorded("demseg_disc", "mass"), f"`{RUN} demseg_disc`"),
    Row(
        "I-2-1",
        "error of its energy over the fall, at the step of the deck, dt_cr/22",
        "–",
        recorded("demseg_disc", "err over the fall", 2),
        "`python cases/demseg_disc/demseg_disc.py`",
    ),
    Row("I-2-1", "the same at dt_cr/10", "small", lambda: f"{at_a_tenth():.2g}", f"`{RUN}` with dt 1.123d-4"),
    Row(
        "I-2-3",
        "ex01-2, two discs in one body: mass of the union",
        "–",
        recorded("demseg_clump", "mass"),
        f"`{RUN} demseg_clump`",
    ),
    Row(
        "I-2-4",
        "a segment; figure 6, energies add up: error over the fall",
        "–",
        recorded("demseg_segment", "err over the fall", 2),
        f"`{RUN} demseg_segment`",
    ),
    Row(
        "I-2-4",
        "the same at a tenth of the step",
        "–",
        recorded("demseg_segment", "the same at a tenth of the step", 2),
        "`python cases/demseg_segment/demseg_segment.py`",
    ),
    Row(
        "I-2-5",
        "three segments make a triangle: mass of the inside",
        "–",
        recorded("demseg_triangle", "mass"),
        f"`{RUN} demseg_triangle`",
    ),
    Row(
        "I-3",
        "segment pushed with 1e4: x at step 10",
        "-2.99982",
        recorded("demseg_control", "pushed: place x at step 10", 6),
        f"`{RUN} demseg_control/pushed`",
    ),
    Row("I-3", "x at step 20", "-2.99933", recorded("demseg_control", "pushed: place x at step 20", 6), "the same"),
    Row(
        "I-3",
        "its angle at step 20, rotation held",
        "1.57082",
        recorded("demseg_control", "moved: angle at the end", 6),
        f"`{RUN} demseg_control/moved`",
    ),
    Row(
        "I-3",
        "figure 9, soil pushes a block: it slides at this weight over that of limit equilibrium",
        "picture",
        recorded("block_pushed_by_soil", "free block that goes 10 mm: weight over the critical one", 3),
        "`python cases/block_pushed_by_soil/block_pushed_by_soil.py`",
    ),
    Row(
        "I-4",
        "V = √(k/m) dx",
        "6487",
        lambda: f"{2.0 / spring(2.5 * math.pi * 1.21, 1e8):.1f}",
        "`python cases/chain_pulse/chain_pulse.py`",
    ),
    Row(
        "I-4",
        "figure 10, speed of the pulse from No. 13 to 17",
        "5700",
        recorded("chain_pulse", "displacement, mean of both"),
        "the same",
    ),
    Row(
        "I-4",
        "figure 12, springs 100 times as soft: largest difference of vertical speeds",
        "hardly any",
        recorded("rolling_on_a_slope", "difference of vertical speeds on the slope, of the largest", 2),
        "`python cases/rolling_on_a_slope/rolling_on_a_slope.py`",
    ),
    Row("I-5", "critical dashpot, e = 0", "0.5605e4", lambda: f"{2e-4 * math.sqrt(1e8 * BALL):.4f}e4", "2√(k m)"),
    Row(
        "I-5",
        "dashpot of e = 0.5",
        "0.1205e4",
        lambda: f"{2e-4 * math.sqrt(1e8 * BALL) * half():.4f}e4",
        "e = exp(-π h/√(1 - h²))",
    ),
    Row(
        "I-5",
        "figure 14, height of the first bounce with that dashpot",
        "1/4",
        recorded("bouncing_disc", "the tutorial's c, ends without overlap: first height"),
        "`python cases/bouncing_disc/bouncing_disc.py`",
    ),
    Row(
        "I-6",
        "figure 16, longest step at h = 1/2, over √(m/k)",
        "1.236068; stable at 1.23, not at 1.24",
        recorded("step_stability", "longest step, h = 0.5"),
        "`python cases/step_stability/step_stability.py`",
    ),
    Row("I-6", "dt_cr of ex01-1", "1.123e-3", lambda: f"{2e3 * spring(DISC, 1e8):.3f}e-3", "2√(m/k)"),
    Row(
        "I-6",
        "ex01-1 at dt_cr/2",
        "diverges",
        said("bounces on; runs away at 0.6 dt_cr"),
        "[demseg_disc](../cases/demseg_disc/README.md) has why",
    ),
    Row(
        "I-7",
        "discs of radii 1 to 2 in 80 × 80, void ratio 0.5",
        "582",
        recorded("demseg_repose", "discs"),
        f"`{RUN} demseg_repose`",
    ),
    Row(
        "I-7",
        "figure 19, angle of the slope; one packing is worth ± 1.9°",
        "picture",
        recorded("demseg_repose", "angle", 3),
        "`python cases/demseg_repose/demseg_repose.py`",
    ),
    Row(
        "I-7",
        "it saturates: more at four times the friction",
        "small",
        recorded("angle_of_repose", "angle at four times the friction, more", 2),
        "`python cases/angle_of_repose/angle_of_repose.py`",
    ),
    Row(
        "I-8",
        "grains 8 times as large in an element test: largest difference of stress ratios",
        "none",
        recorded("grain_size", "largest difference of stress ratios, grains eight times as large", 2),
        "`python cases/grain_size/grain_size.py`",
    ),
    Row(
        "I-8",
        "in a short shear box: peak stress ratio, more",
        "larger",
        recorded("grain_size", "peak, short boxes less long", 2),
        "the same",
    ),
    Row(
        "II-2", "corners of polygons are twice as stiff", "2", said("1; 2 with `--rule each`"), f"`{RUN} … --rule each`"
    ),
    Row(
        "II-3",
        "chain: tensions of in_cf0.dat",
        "-20000000",
        lambda: f"{-float(recorded('demseg_chain', 'tensions of the first step', 8)()):.0f}",
        f"`{RUN} demseg_chain`",
    ),
    Row(
        "II-3",
        "pull at which it breaks, over k δ0",
        "1",
        lambda: f"{float(recorded('demseg_chain', 'pull that breaks it', 6)()) / 2e7:.4f}",
        f"`{RUN} demseg_chain/pulled`",
    ),
    Row(
        "II-3",
        "figure 24 (c), distance from the catenary, of the sag",
        "picture",
        recorded("hanging_chain", "hanging: largest distance from the catenary, of the sag", 2),
        "`python cases/hanging_chain/hanging_chain.py`",
    ),
    Row(
        "II-4.1",
        "304 discs: stiffness, tensile, compressive strength over the naive ones",
        "1/2, 1/4, 1/2",
        validated("dem.rock_of_discs"),
        f"`{VERIFY} dem.rock_of_discs`; [rock](../cases/rock/README.md) has why not 1/2",
    ),
    Row(
        "II-4.1",
        "compressive over tensile strength",
        "2",
        validated("dem.rock_of_discs_is_weak_when_pressed"),
        f"`{VERIFY} dem.rock_of_discs_is_weak_when_pressed`",
    ),
    Row(
        "II-4.2",
        "triangles, and their segments, of 304 discs",
        "537, 1611",
        lambda: ", ".join(map(str, parts("triangles"))),
        "`porescale demseg volonoi FOLDER`",
    ),
    Row("II-4.2", "Voronoi cells", "304", lambda: str(parts("cells")[0]), "the same"),
    Row(
        "II-4.2",
        "triangles, every segment for itself: contacts over those of discs, stiffness over k",
        "10, √10/2 = 1.58",
        validated("dem.rock_of_triangles_that_count_each"),
        f"`{VERIFY} dem.rock_of_triangles_that_count_each`",
    ),
    Row(
        "II-4.2",
        "their stiffness over that of the discs of the same packing",
        "√10 = 3.16",
        said("5.1: not met"),
        "[rock](../cases/rock/README.md), Corners that count twice",
    ),
    Row(
        "II-4.2",
        "compressive over tensile strength, corners once, one packing of 80 discs, tan 27°: triangles, cells",
        "10, more",
        validated("dem.rock_of_polygons_is_strong_when_pressed"),
        f"`{VERIFY} dem.rock_of_polygons_is_strong_when_pressed`",
    ),
    Row(
        "II-4.2",
        "the same of triangles of two packings of 152 discs",
        "10",
        recorded("rock", "triangles: compressive over tensile", 2),
        "`python cases/rock/rock.py`",
    ),
    Row(
        "II-4.2",
        "the same, every segment for itself, one packing of 304 discs: tan 27°, friction 0.25",
        "10",
        said("14.3, 10.7"),
        "[rock](../cases/rock/README.md), Corners that count twice",
    ),
)


@cache
def at_a_tenth() -> float:
    """Error of the energy of ex01-1 over the fall at a tenth of the tutorial's dt_cr, in the steps of the deck."""
    folder = CASES / "demseg_disc"
    return unbalanced(trace(folder, replace(read_deck(folder), dt=1.123e-4)))


def half() -> float:
    """h of e = 0.5."""
    return math.log(2.0) / math.hypot(math.pi, math.log(2.0))


def table() -> str:
    """The table of the page."""
    lines = (f"| {row.section} | {row.what} | {row.printed} | {row.here()} | {row.command} |\n" for row in ROWS)
    return HEAD + "".join(lines)


def with_table(text: str, made: str) -> str:
    """The page with another table."""
    return re.sub(f"{BEGIN}.*?{END}", lambda _: f"{BEGIN}{made}{END}", text, flags=re.DOTALL)


if __name__ == "__main__":
    PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8"), table()), encoding="utf-8")
