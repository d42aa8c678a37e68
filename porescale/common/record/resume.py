"""Going on from a checkpoint: all that it holds is checked before anything of the run is touched.

A checkpoint may be cut, spoilt, of another scene, another program or a later version, or a file that is none: each is
an InputError of one line, and the run folder stays as it is.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from porescale.common.core.errors import InputError, Unstable
from porescale.common.record.check_state import CHECKPOINT, misfit, other, senseless
from porescale.common.record.checkpoint import read_checkpoint, read_header
from porescale.common.record.cost import Cost
from porescale.common.record.model import Model
from porescale.common.record.part import MISFITS
from porescale.common.record.schedule import Schedule


@dataclass(frozen=True)
class Reached:
    """How far the run of a checkpoint is: ``step``, ``time`` (s), and wall-clock ``seconds`` that it took."""

    step: int
    time: float
    seconds: float


@dataclass(frozen=True)
class Saved:
    """What a checkpoint holds of the run's files.

    series_bytes, table_bytes : length of the scheduled rows;  row_step, snapshot_step : of the last scheduled ones;
    last_snapshot_step : of the last one, which may be there only because the run ended;  sample_steps : of the last
    scheduled samples, by name.
    """

    reached: Reached
    cost: Cost
    series_bytes: int
    table_bytes: dict[str, int]
    row_step: int
    snapshot_step: int
    last_snapshot_step: int
    sample_steps: dict[str, int]


def how_far(folder: Path) -> Reached:
    """That of the run in ``folder``, whatever the size of its state.  InputError where its checkpoint is none."""
    try:
        return _reached(read_header(folder / CHECKPOINT))
    except MISFITS as error:
        raise misfit(folder, "holds no state of a run", error) from error


def require_same_run(folder: Path, reached: Reached, card: Mapping[str, Any]) -> None:
    """InputError where a checkpoint stands at another step than the ``card`` of a run that came to its end."""
    if card.get("step") != reached.step:
        error = ValueError(f"step {reached.step}, the run ended at {card.get('step')}")
        raise misfit(folder, "is not this run's", error)


def take_up(folder: Path, model: Model, schedules: Mapping[str, Schedule]) -> Saved:
    """Set ``model`` and ``schedules`` to where the checkpoint in ``folder`` left them.

    InputError where the checkpoint is not that of such a model, or of a state that is not valid.
    """
    content = read_checkpoint(folder / CHECKPOINT)
    try:
        meta = content["record"]
        saved = Saved(
            _reached(content),
            Cost.restored(content.get("cost", {})),
            int(meta["series_bytes"]),
            {str(name): int(size) for name, size in meta.get("table_bytes", {}).items()},
            int(meta["row_step"]),
            int(meta["snapshot_step"]),
            int(meta["last_snapshot_step"]),
            {str(name): int(step) for name, step in meta.get("sample_steps", {}).items()},
        )
        wrong = senseless(content["state"]) or other(model.state(), content["state"])
        if wrong:
            raise ValueError(wrong)
        model.restore(content["state"])
        for name, schedule in schedules.items():
            schedule.restore(content["schedules"][name], model.time)
    except (*MISFITS, InputError) as error:
        cause = error.__cause__ or error  # of a state that does not fit
        reason = f"holds no {cause}, which this version saves" if isinstance(cause, KeyError) else cause
        raise misfit(folder, "does not fit this model", reason) from error
    try:
        model.check()
    except Unstable as error:
        raise misfit(folder, "holds an invalid state", error) from error
    return saved


def _reached(content: Mapping[str, Any]) -> Reached:
    return Reached(int(content["step"]), float(content["time"]), float(content["seconds"]))
