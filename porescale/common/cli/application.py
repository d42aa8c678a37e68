"""The command line that every package has, and how a command ends."""

import atexit
import codecs
import errno
import gc
import io
import os
import sys
from collections.abc import Sequence
from typing import Any, get_args

from cyclopts import App, CycloptsError, Parameter, Token, convert

from porescale.common.cli import bench, cases, check, completion, measure, new, run, schema, show, study, sweep, verify
from porescale.common.cli.diagnostics import printed
from porescale.common.cli.package import Package
from porescale.common.core.errors import INTERRUPTED, InputError, PorescaleError
from porescale.common.core.version import VERSION
from porescale.common.page import command as report
from porescale.common.watch import command as watch

QUOTA = getattr(errno, "EDQUOT", errno.ENOSPC)
OF_THE_MACHINE = (errno.ENOSPC, QUOTA, errno.EACCES, errno.EPERM, errno.EROFS, errno.EIO, errno.EFBIG)
"""What the system may answer to any call, even where it names no file."""
OF_A_NAME = (errno.ENAMETOOLONG, errno.ELOOP)
"""What it answers to a name that can be no file's, whatever is on the disk."""


GARBAGE = 50_000
"""Objects after which Python looks for cycles of them that nothing refers to: imports make many that stay, and with its
own 700 a twelfth of the time that ``check`` takes is spent on looking."""

PLAIN = {"²": "^2", "³": "^3", "±": "+-", "·": "*", "–": "-", "…": "...", "→": "->", "ν": "nu", "τ": "tau", "ρ": "rho"}
"""Signs of reports and messages as a terminal without them is given them."""


def application(package: Package) -> App:
    """The package's app with the commands that all have; more may be added to it."""
    app = App(
        name=package.name,
        help=package.summary,
        version=VERSION,
        default_parameter=Parameter(negative=(), converter=_whole),
        result_action="return_value",
        suppress_keyboard_interrupt=False,
        print_error=False,
        exit_on_error=False,
    )
    for part in (run, check, show, report, watch, measure, new, schema, cases, sweep, verify, bench, study):
        app.command(part.command(package))
    app.command(completion.command(app), name="--install-completion")
    return app


def _whole(kind: Any, tokens: Sequence[Token]) -> Any:
    """The value of an option's words; ValueError for 1.5 where a whole number is needed, which would be rounded."""
    for token in tokens if int in (kind, *get_args(kind)) else ():
        if "." in token.value:
            raise ValueError(f'"{token.value}" is no whole number')
    return convert(kind, tokens)


def main(app: App, tokens: Sequence[str] | None = None) -> int:
    """Run a command line (``sys.argv`` if None) and give its exit code.

    0 done, 1 a check or run failed, 2 wrong use or input, 3 unstable, 130 interrupted.  What people can cause is
    printed in one line each on stderr; any other exception is a bug of the package and keeps its traceback.
    """
    gc.set_threshold(GARBAGE)
    atexit.register(gc.freeze)  # nor need it look at what stays once more before it ends: a sixth
    _print_anywhere()
    try:
        with printed():
            result = app(list(sys.argv[1:] if tokens is None else tokens))
        if sys.stdout is not None:  # closed by who started the command
            sys.stdout.flush()
        return result if isinstance(result, int) else 0
    except CycloptsError as error:
        _say(f"{app.name[0]}: {error}")
        return InputError.code
    except InputError as error:
        for fault in error.faults:
            _say(fault.line())
        return error.code
    except PorescaleError as error:
        _say(str(error))
        return error.code
    except KeyboardInterrupt:
        _say("interrupted")
        return INTERRUPTED
    except MemoryError as error:
        _say(f"not enough memory ({error}); make the scene coarser or smaller" if str(error) else "not enough memory")
        return PorescaleError.code
    except BrokenPipeError:  # the reader of our output left, as `| head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PorescaleError.code
    except OSError as error:
        if error.filename is None and error.errno not in OF_THE_MACHINE:
            raise
        _say(f"{error.filename if error.filename is not None else 'writing'}: {error.strerror or error}")
        return InputError.code if error.errno in OF_A_NAME else PorescaleError.code


def _print_anywhere() -> None:
    """Let stdout and stderr spell what their encoding has no sign for, in place of UnicodeEncodeError."""
    codecs.register_error("porescale.plain", _plain)
    for stream in (sys.stdout, sys.stderr):
        if not isinstance(stream, io.TextIOWrapper):
            continue
        if stream.errors == "strict" or codecs.lookup(stream.encoding).name != "utf-8":
            stream.reconfigure(errors="porescale.plain")


def _plain(error: UnicodeError) -> tuple[str | bytes, int]:
    """What stands for characters that cannot be encoded: their spelling, else a question mark for each."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(PLAIN.get(sign, "?") for sign in error.object[error.start : error.end]), error.end


def _say(text: str) -> None:
    print(" ".join(text.split()), file=sys.stderr)
