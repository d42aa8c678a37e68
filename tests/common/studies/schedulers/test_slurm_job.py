"""A job of Slurm asks for another one while its run goes on, and for none where it does not."""

import threading
from dataclasses import replace

import pytest

from porescale.common.core.errors import PorescaleError
from porescale.common.studies.schedulers import slurm_job
from porescale.common.studies.schedulers.task import Task
from tests.reference.toy_command import run_alone


def test_a_run_that_saves_nothing_in_the_time_of_a_job_is_not_queued_for_ever(tmp_path, monkeypatch):
    job = slurm_job.SlurmJob(600.0)
    task = Task("a", "toy", ("run",), tmp_path / "a")
    job._began, job._step, job._ended = -1e9, -1, threading.Event()
    job._ended.set()
    job._process = slurm_job.Process(task)
    with pytest.raises(PorescaleError, match="no checkpoint within the 10 min of a job"):
        job.checkpoint(task)
    monkeypatch.setattr(slurm_job, "reached", lambda task: 7)
    assert job.checkpoint(task).args == (task,)


def test_the_time_of_a_job_counts_from_where_its_run_begins(tmp_path, monkeypatch):
    folder = run_alone(3, tmp_path / "alone")
    task = Task("a", "toy", ("run",), folder)
    whole = slurm_job.reached(task)
    assert whole == 100
    card = folder / "card.json"
    card.write_text(card.read_text().replace('"outcome": "finished"', '"outcome": "unstable"'))
    anew = replace(task, again=True)
    assert (slurm_job.reached(task), slurm_job.reached(anew)) == (whole, -1)  # its old checkpoint is no use to it
    job = slurm_job.SlurmJob(600.0)
    job._began, job._step, job._ended = -1e9, slurm_job.reached(anew), threading.Event()
    job._ended.set()
    job._process = slurm_job.Process(anew)
    with pytest.raises(PorescaleError, match="no checkpoint within"):  # it still packs, beside that checkpoint
        job.checkpoint(anew)
    card.write_text(card.read_text().replace('"outcome": "unstable"', '"outcome": "interrupted"'))
    assert job.checkpoint(anew).args == (anew,)
