"""What `--scheduler slurm:partition=long,time=2h,account=abc` asks of Slurm."""

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.units import to_si
from porescale.common.studies.schedulers.law import OPTION

SHORTEST, USUAL = 5.0, 60.0
"""Minutes of a job: the fewest that leave it time to save its state before Slurm ends it, and those it has unless more
are asked for.  A run that takes longer is queued again and goes on."""
BYTES = {"M": 2**20, "G": 2**30, "T": 2**40}


def parameters(text: str, threads: int) -> dict[str, Any]:
    """Parameters of submitit's SlurmExecutor, from the value of the option; InputError with all that is wrong.

    threads : of each run, the cores of its job.
    """
    word, _, rest = text.partition(":")
    assert word == "slurm"
    made: dict[str, Any] = {"time": math.ceil(USUAL), "cpus_per_task": threads}
    faults, seen = [], set[str]()
    for part in filter(None, rest.split(",")):
        key, _, value = (it.strip() for it in part.partition("="))
        try:
            if key not in READ:
                raise ValueError(f"{key!r} is not known")
            if key in seen:
                raise ValueError(f"{key} is given twice")
            seen.add(key)
            made |= READ[key](value)
        except ValueError as error:
            repair = "write it as slurm:partition=long,time=2h,memory=4G"
            faults.append(Fault(OPTION, text, str(error), "", ", ".join(READ), repair))
    if faults:
        raise InputError(faults)
    return made


def _word(name: str) -> Callable[[str], dict[str, Any]]:
    """Reads a name that Slurm knows."""

    def read(value: str) -> dict[str, Any]:
        """It under its name, ValueError where it can be none."""
        if not re.fullmatch(r"[\w.@&|!+-]+", value):
            raise ValueError(f"{name}={value} names nothing")
        return {name: value}

    return read


def _minutes(value: str) -> dict[str, Any]:
    """The time limit ``value``, in whole minutes, rounded up; ValueError for what is no time or too short."""
    try:
        found = to_si(value, "s") / 60
    except ValueError:
        raise ValueError(f"time={value} is no time; write it as 90min, 2h or 3d") from None
    if found < SHORTEST:
        raise ValueError(f"time={value} is less than {SHORTEST:g}min")
    return {"time": math.ceil(found)}


def _memory(value: str) -> dict[str, Any]:
    """Memory of a job, in whole MiB as Slurm counts it."""
    match = re.fullmatch(r"(\d+(?:\.\d+)?)([MGT])(?:i?B)?", value)
    if match is None or not (bytes_ := float(match[1]) * BYTES[match[2]]):
        raise ValueError(f"memory={value} is no memory; write it as 500M or 4G")
    return {"mem": f"{math.ceil(bytes_ / BYTES['M'])}M"}


def _gpus(value: str) -> dict[str, Any]:
    """Graphics devices of a job."""
    if not value.isdecimal() or not int(value):
        raise ValueError(f"gpus={value} is no number of them")
    return {"gpus_per_node": int(value)}


READ: Mapping[str, Callable[[str], dict[str, Any]]] = {
    "partition": _word("partition"), "account": _word("account"), "qos": _word("qos"),
    "constraint": _word("constraint"), "time": _minutes, "memory": _memory, "gpus": _gpus,
}  # fmt: skip
"""What may be asked for, and what reads it."""
