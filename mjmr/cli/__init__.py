"""The command line: find the command, parse, call, print. What is heavy loads when it is used."""

import importlib
import os
import sys
from collections.abc import Sequence

from mjmr.errors import InvalidInputError, MjmrError, UnknownNameError

COMMANDS = {
    "list": "studies there are",
    "show": "a study's paper, conditions, claims, bounds, and what each size costs",
    "run": "run a study and say claim by claim whether the paper holds",
    "compare": "set two runs of a study against each other, seed by seed",
    "trial": "run one trial: its metrics, a film, a trace",
    "replay": "film a trace, or the last second of a trial that failed",
    "film": "make a study's film",
    "mjcf": "write the MuJoCo model of one of a study's conditions",
    "robots": "the robots there are: size, mass, speed, sensors, what was measured; pictures",
    "bench": "measure speed",
    "export": "write results as CSV or Parquet",
}
_HELP = """\
mjmr - MuJoCo multi-robot testbed

Runs published multi-robot systems in contact physics and says claim by claim whether the paper's
findings hold.

USAGE
  mjmr COMMAND [ARGUMENTS]
  mjmr COMMAND --help
  mjmr --version

COMMANDS
{commands}

EXAMPLES
  mjmr list
  mjmr show safe-navigation
  mjmr run safe-navigation
  mjmr run safe-navigation --size standard --check
  mjmr run safe-navigation --only sigma_mm=0,4 --seeds 10 --out renders/trial
  mjmr run safe-navigation --with navigator=dash.py:Dash
  mjmr trial safe-navigation scene=cross4 --seed 7 --film
  mjmr robots pioneer2dx --view

FILES
  renders/STUDY/SIZE/   what a run leaves: results.sqlite, claims.json, claims.md, run.json,
                        plots, film.mp4, failures/; with swapped parts in
                        renders/STUDY/SIZE+ROLE=Class/

ENVIRONMENT
  MJMR_DEBUG=1     show tracebacks
  MJMR_STUDIES     more studies, as name=package.module:attribute, separated by spaces

EXIT CODES
  0    done; of a run: all trials finished
  1    something failed: a trial, a plot, a film
  2    bad input, or a results folder that cannot be used; one sentence says which
  3    with --check: a verdict differs from the committed one
  130  interrupted with Ctrl-C; the same command resumes
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        argv: Arguments without the program's name; None takes those of the process.

    Returns:
        The exit code; see ``mjmr --help``.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    debug = os.environ.get("MJMR_DEBUG", "") not in ("", "0")
    try:
        code = _dispatch(arguments)
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        # The reader has left; what Python would flush at exit has nowhere to go.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    except KeyboardInterrupt:
        print("mjmr: interrupted", file=sys.stderr)
        return 130
    except MjmrError as e:
        if debug:
            raise
        return _complain(str(e), 2)
    except Exception as e:
        if debug:
            raise
        return _complain(f"unexpected {type(e).__name__}: {e} (MJMR_DEBUG=1 shows where)", 1)


def _dispatch(arguments: list[str]) -> int:
    if not arguments:
        raise InvalidInputError(f"a command is missing: {', '.join(COMMANDS)}; see mjmr --help")
    name, *rest = arguments
    if name in ("-h", "--help", "help"):
        print(_help(), end="")
        return 0
    if name == "--version":
        from mjmr.provenance import versions

        print(f"mjmr {versions()['mjmr']}")
        return 0
    if name not in COMMANDS:
        raise UnknownNameError("command", name, COMMANDS)
    return importlib.import_module(f"mjmr.cli.{name}_command").main(rest)


def _help() -> str:
    width = max(map(len, COMMANDS))
    told = "\n".join(f"  {name:{width}}  {text}" for name, text in COMMANDS.items())
    return _HELP.format(commands=told)


def _complain(text: str, code: int) -> int:
    print("mjmr: " + " ".join(text.split()), file=sys.stderr)
    return code
