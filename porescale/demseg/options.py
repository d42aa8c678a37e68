"""The options of a run in in_cf.dat: the run that goes on from it must have the same, or it would be another system.

release is kept of every deck;  rule, and the width of segments that weigh, of decks with segments.  Files without
options, written before they were kept, are taken as they are.
"""

from pathlib import Path
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.demseg.build import Options, width_of
from porescale.demseg.deck import Deck

WORDS = {"release": ("overlap", "force"), "rule": ("outline", "each", "printed")}
"""Choices in the order of their numbers in in_cf.dat, which holds no words."""


def kept_options(deck: Deck, options: Options) -> dict[str, int | float]:
    """The options of a run of ``deck`` as numbers, see module."""
    kept: dict[str, int | float] = {"release": WORDS["release"].index(options.release)}
    if any(body.segments for body in deck.bodies):
        kept |= {"rule": WORDS["rule"].index(options.rule), "rod": width_of(deck, options)}
    return kept


def require_kept(before: dict[str, Any], deck: Deck, options: Options, path: Path) -> None:
    """Raise InputError, a fault for each option, where the state ``before`` of the file ``path`` had another."""
    faults = []
    now, then = kept_options(deck, options), before.get("options", {})
    for name, value in now.items():
        if not isinstance(then, dict) or name not in then:
            continue
        words = WORDS.get(name)
        if not isinstance(then[name], int | float) or (words and then[name] not in range(len(words))):
            among = f"0 to {len(words) - 1}" if words else "a width"
            faults.append(
                Fault(f"options/{name}", str(then[name]), f"makes no sense, expected {among}", file=str(path))
            )
            continue
        if then[name] == value:
            continue
        had, has = (words[int(it[name])] if words else f"{it[name]:g}" for it in (then, now))
        problem = f"is {has}, but the run before had {had}"
        faults.append(Fault(f"--{name}", None, problem, repair=f"give --{name} {had}", file=str(path)))
    if faults:
        raise InputError(faults)
