"""`--install-completion`: commands and options completed by the shell's Tab key."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import App, Parameter

from porescale.common.api.folders import unusable
from porescale.common.core.errors import Fault, InputError

Shell = Annotated[
    Literal["bash", "zsh", "fish", "powershell"] | None, Parameter(help="the one this is run in if not given")
]
Output = Annotated[
    Path | None,
    Parameter(help="file to write; the shell's own place, and a line in its start-up file, if not given"),
]


def command(app: App) -> Callable[..., int]:
    """The command that installs completion of ``app``."""

    def install_completion(*, shell: Shell = None, output: Output = None) -> int:
        """Install completion of commands and options by the Tab key (bash, zsh, fish, PowerShell)."""
        from cyclopts.completion import ShellDetectionError, detect_shell

        try:
            chosen = shell or detect_shell()
        except ShellDetectionError:
            problem = "is not known from here"
            repair = "name it: --install-completion --shell bash, zsh, fish or powershell"
            raise InputError(Fault("--shell", None, problem, repair=repair)) from None
        try:
            if output is not None:
                output.parent.mkdir(parents=True, exist_ok=True)
            place = app.install_completion(shell=chosen, output=output, add_to_startup=output is None)
        except OSError as error:
            raise unusable(output or Path.home(), "--output", error) from error
        print(f"{place}: read by {chosen} when it starts" if output is None else place)
        return 0

    return install_completion
