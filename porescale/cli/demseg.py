"""``porescale demseg``: a deck of DEMseg as it is, or as a scene."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter

from porescale.common.api.folders import check_folder
from porescale.common.cli.options import Threads, use_threads
from porescale.common.cli.run import summary
from porescale.common.core.errors import Fault, InputError, warn

if TYPE_CHECKING:
    from porescale.common.record.drive import Outcome
    from porescale.demseg.run import DeckRun

PACKAGE = "porescale demseg"
CHECKPOINT_SECONDS = 30.0
"""Wall-clock time between checkpoints."""
Folder = Annotated[Path, Parameter(help="folder with in_gm.dat and in_bc.dat, or name of a case (see `cases`)")]
Seed = Annotated[int, Parameter(help="of the random discs of mode 0")]
Release = Annotated[Literal["overlap", "force"], Parameter(help="contacts end without overlap, or without force")]
Rule = Annotated[Literal["outline", "each", "printed"], Parameter(help="of contacts with segments")]
Rod = Annotated[float | None, Parameter(help="width of segments that weigh; 2 thick, or 0.1, if not given")]


def command() -> App:
    """The `demseg` command with its own commands."""
    app = App(name="demseg", help="Run a deck of DEMseg, Matsushima's program, in its own units, or make it a scene.")
    app.command(run)
    app.command(convert)
    app.command(volonoi)
    return app


def run(
    folder: Folder,
    /,
    *,
    out: Annotated[Path | None, Parameter(help="run folder; runs/ and the name of the deck's if not given")] = None,
    seed: Seed = 0,
    release: Release = "overlap",
    rule: Rule = "outline",
    rod: Rod = None,
    threads: Threads = None,
    resume: Annotated[bool, Parameter(help="go on with the run in the run folder")] = False,
    overwrite: Annotated[bool, Parameter(help="replace the run in the run folder")] = False,
    quiet: Annotated[bool, Parameter(help="no progress, no summary")] = False,
) -> int:
    """Run a deck: run folder, the files of DEMseg, and new_in_*.dat for the run that goes on from its end."""
    from porescale.common.record.drive import check_resume
    from porescale.demseg.build import Options
    from porescale.demseg.deck import read_deck
    from porescale.demseg.run import DeckRun, card_of

    options = Options(seed, release, rule, rod)
    folder = _deck_folder(folder)
    deck = read_deck(folder)
    name = folder.resolve().name
    where = out or Path("runs") / name
    check_folder(where, PACKAGE, resume=resume, overwrite=overwrite)
    scene = card_of(deck, options)
    if resume:
        check_resume(where, {"package": PACKAGE, "name": name, "scene": scene})
    use_threads(threads)
    model = DeckRun(deck, options, folder)
    for text in model.doubts():
        warn(text)
    outcome = drive_deck(model, where, name, scene, resume=resume, overwrite=overwrite, quiet=quiet)
    if not quiet:
        print(summary("porescale", name, where, outcome).rsplit("\n", 1)[0])
    return 0


def _deck_folder(given: Path) -> Path:
    """``given`` where it is there, else the case of that name where there is one."""
    from porescale.common.api.shipped import find_case

    return given if given.exists() else find_case(given) or given


def drive_deck(
    model: DeckRun,
    folder: Path,
    name: str,
    scene: dict[str, object],
    *,
    resume: bool = False,
    overwrite: bool = False,
    quiet: bool = True,
) -> Outcome:
    """Drive a deck to its last step and write the run folder, pictures, film and the deck's own files."""
    from porescale.common.record.drive import drive

    deck = model.deck

    def after(finished: Path) -> None:
        """Leave the pictures and the deck's own files."""
        show(finished)
        model.write(finished)

    return drive(
        model,
        folder,
        deck.nstep * deck.dt,
        snapshot_interval=deck.nprn1 * deck.dt,
        series_interval=deck.nprn2 * deck.dt,
        card={"package": PACKAGE, "name": name, "scene": scene},
        checkpoint_seconds=CHECKPOINT_SECONDS,
        resume=resume,
        overwrite=overwrite,
        quiet=quiet,
        after=after,
        meanwhile=model.write_tables,
    )


def show(folder: Path) -> list[Path]:
    """Write pictures and a film of the deck's run in ``folder``, finished or not; returns their paths."""
    from porescale.common.pictures.film import painted
    from porescale.common.record.open_run import open_run
    from porescale.output.deck_pictures import write_deck_pictures
    from porescale.output.show import look_of

    run = open_run(folder)
    look = look_of(run)
    assert look.view
    own = write_deck_pictures(run, folder, look.view) if "contacts" in run.clouds else []
    return [*painted(folder, look), *own]


def convert(
    folder: Folder,
    /,
    *,
    out: Annotated[Path | None, Parameter(help="scene file; NAME.toml here if not given")] = None,
    units: Annotated[
        Literal["plain", "cgs", "mm-g"],
        Parameter(help="of the deck; plain: its numbers are taken as SI. Densities of mm-g are g/mm^3"),
    ] = "plain",
    seed: Seed = 0,
    release: Release = "overlap",
    rule: Rule = "outline",
    rod: Rod = None,
    overwrite: Annotated[bool, Parameter(help="replace the file")] = False,
) -> int:
    """Make a scene of a deck."""
    from porescale.common.api.folders import require_file
    from porescale.common.core.atomic import write_text
    from porescale.demseg.build import Options
    from porescale.demseg.convert import UNITS, scene_of, stretched, toml
    from porescale.demseg.deck import GO_ON, read_deck
    from porescale.demseg.run import DeckRun
    from porescale.demseg.tension import tensions

    options = Options(seed, release, rod=rod)
    folder = _deck_folder(folder)
    deck = read_deck(folder)
    name = folder.resolve().name
    file = out or Path(f"{name}.toml")
    require_file(file, "--out")
    if file.exists() and not overwrite:
        raise InputError(Fault("--out", str(file), "is there already", repair="name another, or --overwrite it"))
    if rule != "outline" and any(body.segments for body in deck.bodies):
        problem = "scenes count corners of segments once"
        raise InputError(Fault("--rule", rule, problem, allowed="outline", repair="use porescale demseg run"))
    model = DeckRun(deck, options, folder)
    bonds = tensions(model.built) if model.grains.bonds is not None else None
    text = toml(scene_of(model.deck, name, release, UNITS[units], bonds, rod))
    refused = _require_valid_scene(text)
    write_text(file, text)
    if deck.jclid == GO_ON and (count := stretched(model.grains)):
        which = "1 contact" if count == 1 else f"{count} contacts"
        print(f"{file}: leaves out the tangential springs of {which}: scenes start with them at rest")
    for line in refused:
        warn(f"{file}: porescale check refuses it, though demseg run takes the deck: {line}")
    print(f"{file}: check it with porescale check {quote(str(file))}")
    return 0


def volonoi(
    folder: Folder,
    /,
    *,
    out: Annotated[Path | None, Parameter(help="folder of the two files; here if not given")] = None,
    pressed: Annotated[float, Parameter(help="overlap of neighbours, in the deck's unit of length")] = 0.0,
    seed: Seed = 0,
    overwrite: Annotated[bool, Parameter(help="replace the files")] = False,
) -> int:
    """Make polygons of the discs of in_gm.dat, thick apart: in_gm_tri.dat (Delaunay) and in_gm_volo.dat (Voronoi)."""
    from porescale.common.api.folders import require_writable
    from porescale.common.core.atomic import write_text
    from porescale.demseg.build import Options, with_bodies
    from porescale.demseg.check import check_bodies
    from porescale.demseg.deck import grains_text, read_grains
    from porescale.demseg.divide import FILES, divided

    options = Options(seed)
    place = out or Path()
    require_writable(place, "--out")
    there = [place / name for name in FILES.values() if (place / name).exists()]
    if there and not overwrite:
        raise InputError(Fault("--out", str(there[0]), "is there already", repair="name another, or --overwrite it"))
    given = read_grains(_deck_folder(folder))
    check_bodies(given)
    deck = with_bodies(given, options.seed)
    made = {kind: divided(deck, kind, pressed) for kind in FILES}
    place.mkdir(parents=True, exist_ok=True)
    for kind, each in made.items():
        write_text(place / FILES[kind], grains_text(each))
        print(f"{place / FILES[kind]}: {len(each.bodies)} {kind} of {len(deck.bodies)} discs, thick {each.thick:g}")
    return 0


def _require_valid_scene(text: str) -> list[str]:
    """InputError where the scene of a deck exceeds the limits of scenes; lines of what a check of it would refuse."""
    from tempfile import TemporaryDirectory

    from porescale.builders.derive import derive
    from porescale.builders.scene import Scene
    from porescale.common.schema.sections import load

    with TemporaryDirectory() as place:
        file = Path(place) / "scene.toml"
        file.write_text(text, encoding="utf-8")
        try:
            scene = load(file, Scene)
        except InputError as error:
            raise InputError([replace(fault, file="the deck as a scene") for fault in error.faults]) from None
        try:
            derive(scene)
        except InputError as error:
            return [fault.line() for fault in error.faults]
    return []
