"""The table of ensembles of a sweep: ensemble.csv, and the same to read in sweep.md."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from porescale.common.core.statistics import LEAST, LEVEL, Sample, bootstrap
from porescale.common.evidence import files
from porescale.common.studies.ensemble import FAIL, OPEN, Ensemble, Judged, judge
from porescale.common.studies.parameter_table import ENSEMBLE
from porescale.common.studies.quantities import title
from porescale.common.studies.runner import Ended

WORTH = ("mean", "standard deviation", "standard error", "t low", "t high", "bootstrap low", "bootstrap high")
"""What a sample is worth: columns of tables."""
SAID = 40
"""Numbers that are printed where none is judged, about a screen."""
Number = Callable[[Ended, Mapping[str, Any]], float]


class Line(NamedTuple):
    """A quantity of an ensemble.  row : that asks for it, {} where none is known yet;  judged : None there;  cells :
    its line of ensemble.csv, by column."""

    ensemble: Ensemble
    row: Mapping[str, Any]
    judged: Judged | None
    cells: Mapping[str, Any]


def lines_of(found: Sequence[Ensemble], rows: Sequence[Mapping[str, Any]], number: Number) -> list[Line]:
    """A line for each quantity of each ensemble, with what it was made of; one for each ensemble where no quantity is
    known yet.  number : that of a finished run that a row describes."""
    keys = list(dict.fromkeys(text.partition("=")[0] for one in found for text in one.of.settings))
    made = []
    for one in found:
        for row in rows or [{}]:
            known = judge(one, row, number) if row else None
            made.append(Line(one, row, known, _cells(one, keys, row, known)))
    return made


def _cells(one: Ensemble, keys: Sequence[str], row: Mapping[str, Any], known: Judged | None) -> dict[str, Any]:
    """The cells of a line; what there is not is empty."""
    made: dict[str, Any] = {"name": one.of.name, "quality": one.of.quality or ""}
    made |= {key: one.of.value(key) for key in keys}
    made |= {
        "over": " ".join(one.over),
        "members": " ".join(one.members),
        "asked": one.asked,
        "finished": len(one.finished),
    }
    made |= {"quantity": str(row.get("name", "")), "unit": str(row.get("unit", ""))}
    numbers: dict[str, float | None] = dict.fromkeys(("n", *WORTH))
    judgement: dict[str, Any] = dict.fromkeys(("value", "tolerance", "inside", "verdict", "needed", "remark"), None)
    if known is not None:
        numbers = dict(zip(numbers, (len(known.sample.values), *worth(known.sample)), strict=True))
        judgement["remark"] = remark(one, known)
        if known.verdict:
            judgement |= {"value": row["value"], "tolerance": row["tolerance"], "inside": known.inside}
            judgement |= {"verdict": known.verdict, "needed": files.finite(known.needed)}
    return made | numbers | judgement


def worth(sample: Sample) -> list[float | None]:
    """The numbers of WORTH, None for what there is not."""
    ends = sample.mean - sample.half, sample.mean + sample.half, *bootstrap(sample.values)
    made: list[float | None] = files.finite([sample.mean, sample.deviation, sample.error, *ends])
    return made


def remark(one: Ensemble, known: Judged) -> str:
    """What a reader of a number must know besides it; "" where there is nothing."""
    said = [] if one.complete else [one.said()]
    said += [f"{known.absent} without a number"] if known.absent else []
    said += [f"{known.never} never came to it"] if known.never else []
    count = len(known.sample.values)
    said += [f"no interval of {count}, at least {LEAST} are needed"] if count < LEAST else []
    if known.verdict == OPEN and one.complete and known.needed is not None:
        enough = f"about {known.needed:.3g} repeats" if math.isfinite(known.needed) else "more than a million repeats"
        said.append(f"{enough} would resolve it")
    return "; ".join(said)


def csv_text(lines: Sequence[Line]) -> str:
    """The text of ensemble.csv, every number with all its digits."""
    return files.csv_text(lines[0].cells, [line.cells.values() for line in lines])


def markdown(lines: Sequence[Line]) -> list[str]:
    """The lines of sweep.md about ensembles: how many finished, and a table of means with their intervals."""
    found = list(dict.fromkeys(line.ensemble for line in lines))
    text = [
        "", "## Ensembles", "",
        f"Means over repeats ± half of Student's interval at {100 * LEVEL:g} %, beside it the bootstrap's (BCa); all "
        f"digits are in {ENSEMBLE}.csv. A verdict compares Student's interval with what expected.toml allows, which is "
        "for the scene as it is.", "",
        *(f"- {one.of.name}: {one.said()}, over {', '.join(one.over)}" for one in found), "",
    ]  # fmt: skip
    numbers = [line for line in lines if line.judged is not None]
    many, judged = len(found) > 1, any(line.judged.verdict for line in numbers if line.judged)
    header = ["combination"] * many + ["quantity", "n", "mean ± 95 %", "standard error", "one run ±", "bootstrap 95 %"]
    header += ["expected", "runs inside", "verdict"] * judged + ["remark"]
    rows = [[line.ensemble.of.name] * many + _row(line, judged=judged) for line in numbers]
    return text + (files.markdown_table(header, rows) if rows else [])


def _row(line: Line, *, judged: bool) -> list[str]:
    """A row of the table of sweep.md.  judged : whether it has columns for verdicts."""
    it, cells = line.judged, line.cells
    assert it
    ends = (
        " … ".join(short(cells[f"bootstrap {end}"]) for end in ("low", "high")) if math.isfinite(it.sample.half) else ""
    )
    made = [title(line.row), str(cells["n"]), with_bar(it), short(cells["standard error"])]
    made += [short(cells["standard deviation"]), ends]
    if judged:
        inside = f"{it.inside} of {cells['n']}" if it.verdict else ""
        made += [band(line), inside, f"**{it.verdict}**" if it.verdict == FAIL else it.verdict]
    return [*made, cells["remark"] or ""]


def band(line: Line) -> str:
    """What is expected, "" where nothing is."""
    verdict = line.judged.verdict if line.judged else ""
    return f"{short(line.cells['value'])} ± {short(line.cells['tolerance'])}" if verdict else ""


def with_bar(it: Judged) -> str:
    """Mean and half of Student's interval, both to the second digit of the latter; the mean alone without one."""
    mean, half = it.sample.mean, it.sample.half
    if not it.sample.values:
        return "never" if it.never else ""
    if not math.isfinite(half):
        return short(mean)
    if half == 0.0:
        return f"{short(mean)} ± 0"
    digits = 1 - math.floor(math.log10(half))
    if 0 <= digits <= 6:
        return f"{mean:.{digits}f} ± {half:.{digits}f}"
    return f"{mean:.{max(1, math.floor(math.log10(max(abs(mean), half))) + digits + 1)}g} ± {half:.2g}"


def short(value: float | None) -> str:
    """Four digits; "" for None."""
    return "" if value is None else f"{value:.4g}"


def printed(lines: Sequence[Line]) -> list[str]:
    """Lines for people: how many finished, and each number that is judged; where none is the first `SAID` numbers."""
    found = list(dict.fromkeys(line.ensemble for line in lines))
    numbers = [line for line in lines if line.judged is not None]
    judged = [line for line in numbers if line.judged and line.judged.verdict]
    made = [f"{one.of.name}: {one.said()}" for one in found]
    for line in judged or numbers[:SAID]:
        assert line.judged
        name = f"{line.ensemble.of.name}, {title(line.row)}" if len(found) > 1 else title(line.row)
        verdict = f"{line.judged.verdict}: " if line.judged.verdict else ""
        expected = f", expected {band(line)}" if line.judged.verdict else ""
        more = f" ({line.cells['remark']})" if line.cells["remark"] else ""
        made.append(f"{verdict}{name} {with_bar(line.judged)}{expected}{more}")
    if not judged and len(numbers) > SAID:
        made.append(f"and {len(numbers) - SAID} numbers more, in {ENSEMBLE}.csv")
    return made


def failed(lines: Sequence[Line]) -> bool:
    """Whether a row fails for the scene as it is, at its own level: in an ensemble that sets nothing but what its
    repeats differ in."""
    own = [line for line in lines if not line.ensemble.of.settings and not line.ensemble.of.quality]
    return any(line.judged is not None and line.judged.verdict == FAIL for line in own)
