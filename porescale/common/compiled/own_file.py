"""Files of a user that hold own laws: reading one, all that it stands on, and what is wrong with it in one line.

Such a file is code: what a scene names is run.
"""

import copyreg
import pickle
import re
import sys
import traceback
from collections.abc import Callable
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType

from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_sources import place, texts_of
from porescale.common.core.errors import Fault, InputError

REFERENCE = re.compile(r"(?P<file>.+\.py):(?P<name>[^\W\d]\w*)")
"""How a scene names a law: file, colon, name of the function."""
PREFIX = "own."
"""What modules of a user's file are called: no library has such a name."""
_READ: dict[Path, tuple[dict[str, str], ModuleType]] = {}
"""Files that were read, with the texts they stood on then."""


def is_reference(value: object) -> bool:
    """Whether a value of a scene is a text that names a law of a file."""
    return isinstance(value, str) and REFERENCE.fullmatch(value) is not None


def law_of(reference: str, folder: Path | None, kind: str) -> OwnLaw:
    """The law that ``reference`` names, of a file relative to ``folder``; InputError in one line where it is none."""
    match = REFERENCE.fullmatch(reference)
    assert match
    path = ((folder or Path()) / match["file"]).resolve()
    name = match["name"]
    if not path.is_file():
        raise InputError(Fault("", reference, f"there is no file {path}", repair="paths count from the scene's folder"))
    names = vars(_module(path, reference))
    found = names.get(name)
    laws = {key: it for key, it in names.items() if isinstance(it, OwnLaw)}
    if not isinstance(found, OwnLaw):
        of_kind = ", ".join(key for key, it in laws.items() if it.kind == kind) or "none"
        problem = f"{path.name} has no {name!r}" if found is None else f"{name} of {path.name} has no decorator"
        repair = f"write @porescale.{kind} above def {name}"
        raise InputError(Fault("", reference, problem, "", f"{kind} of the file: {of_kind}", repair))
    if found.kind != kind:
        problem = f"{name} is made for @{found.kind}, here @{kind} is needed"
        raise InputError(Fault("", reference, problem, repair=f"name a function with @{kind}"))
    return found.named(reference)


def _module(path: Path, reference: str) -> ModuleType:
    """The file as a module: run, unless it was and nothing that it stands on has changed."""
    running = sys.modules.get("__main__")
    if running is not None and _is(running, path):  # a script that names its own laws is not run within itself
        return running
    texts = texts_of(path)
    if path in _READ and _READ[path][0] == texts:
        return _READ[path][1]
    module = _run(path, reference, {Path(it).parts[0].removesuffix(".py") for it in texts})
    _READ[path] = texts, module
    return module


def _is(module: ModuleType, path: Path) -> bool:
    """Whether a module was read from a file."""
    file = getattr(module, "__file__", None)
    return bool(file) and Path(str(file)).resolve() == path


def _run(path: Path, reference: str, beside: set[str]) -> ModuleType:
    """Run the file as a module of its own; modules ``beside`` it that it imports are read anew, and only for it."""
    spec = spec_from_loader(PREFIX + path.stem, None, origin=str(path))
    assert spec
    module = module_from_spec(spec)
    module.__file__ = str(path)
    aside = {name: sys.modules.pop(name) for name in list(sys.modules) if _first(name) in beside and name != "__main__"}
    sys.path.insert(0, str(path.parent))
    written, sys.dont_write_bytecode = sys.dont_write_bytecode, True  # a file changed within a second is read anew
    try:
        text = path.read_text(encoding="utf-8-sig")
        exec(compile(text, str(path), "exec"), vars(module))
    except InputError:
        raise
    except SyntaxError as error:
        where = place(error.filename or str(path), error.lineno)
        raise InputError(Fault("", reference, f"{where}: {error.msg}", repair="correct the file there")) from None
    except (Exception, SystemExit) as error:
        raise InputError(Fault("", reference, _said(error, path), repair="correct the file there")) from None
    finally:
        sys.dont_write_bytecode = written
        sys.path.remove(str(path.parent))
        for name in [name for name in sys.modules if _first(name) in beside and name != "__main__"]:
            del sys.modules[name]
        sys.modules.update(aside)
    return module


def _first(name: str) -> str:
    """First part of a module's dotted name."""
    return name.partition(".")[0]


def _said(error: BaseException, path: Path) -> str:
    """An error of a user's file in one line: the last line of files of its folder that led to it, and what it says."""
    steps = traceback.extract_tb(error.__traceback__)
    own = [it for it in steps if Path(it.filename).resolve().is_relative_to(path.parent)]
    where = place(own[-1].filename, own[-1].lineno) if own else path.name
    return f"{where}: {type(error).__name__}: {error}"


def _again(file: Path, name: str, kind: str, reference: str) -> OwnLaw:
    """The law of a file as another process finds it."""
    return law_of(f"{file}:{name}", None, kind).named(reference)


def _reduced(law: OwnLaw) -> tuple[Callable[..., OwnLaw], tuple[Path, str, str, str]]:
    """How a law is pickled: by its file and its name there."""
    if law.file is None:
        raise pickle.PicklingError(f"{law.reference} stands in no file")
    return _again, (law.file.resolve(), law.name, law.kind, law.reference)


copyreg.pickle(OwnLaw, _reduced)
