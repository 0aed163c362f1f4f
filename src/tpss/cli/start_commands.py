"""The commands that begin, look up and prepare, and the studio: none prints what came of a run."""

from pathlib import Path
from typing import Annotated

import typer

from tpss.cli import complete
from tpss.cli.arguments import (
    Force,
    GeometryFile,
    Library,
    Quiet,
    ScenarioFile,
    argument,
    flag,
    option,
)


def line_constants(
    file: GeometryFile,
    frequency: Annotated[
        float | None,
        option(
            min=0,
            max=10_000,
            metavar="HZ",
            help="Frequency, 0 of direct current; by default that of the file.",
        ),
    ] = None,
    out: Annotated[
        Path | None, option(help="File to write, which supply.catenary of a scenario may name.")
    ] = None,
    _library: Library = None,
    force: Force = False,
) -> None:
    """Print impedances and capacitances of a line, from where its conductors hang and lie.

    The file has the tables `[[conductors]]`: wires of the library or of your own, their places, and what
    they are connected to. The matrices R, X and B are those of the groups, with the return through the
    earth; below stands what one conductor a track comes to, its return included, which is what a
    scenario's catenary is.
    """
    from tpss.cli.line_constants import print_line_constants

    print_line_constants(file, frequency, out, force)


def new(
    folder: Annotated[
        Path | None, argument(metavar="DIR", help="Folder to write; existing files are kept.")
    ] = None,
    from_: Annotated[
        str | None,
        option(
            "--from",
            metavar="NAME",
            help="Write an example that comes with TPSS, and the files that it refers to; list: print "
            "the names of all, and what each is.",
            autocompletion=complete.examples,
        ),
    ] = None,
) -> None:
    """Write a small, commented scenario to start from, or one of the examples.

    By default it consists of scenario.toml and gradients.csv: a line of 60 km with a stop half-way.
    """
    from tpss.cli.new import LIST, list_examples, new_scenario

    if from_ == LIST:
        list_examples()
        return
    if folder is None:
        raise typer.BadParameter("give a folder to write, such as my-line, or --from list")
    new_scenario(folder, from_)


def studio(
    file: ScenarioFile,
    new: Annotated[
        bool,
        flag(
            "--new", help="FILE is a folder, into which a small example is written to start from."
        ),
    ] = False,
    no_browser: Annotated[
        bool, flag("--no-browser", help="Print the address only; open it yourself.")
    ] = False,
    folder: Annotated[
        Path | None,
        option(
            metavar="DIR",
            help="Folder that is opened: files outside it are neither read nor written; by default that "
            "of the scenario.",
        ),
    ] = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port of the address; 0: any that is free.")
    ] = 0,
    _library: Library = None,
) -> None:
    """Edit a scenario in the browser, while its results follow.

    The page is served on this computer only, at an address with a secret token, and loads nothing from
    the network. What is edited is kept as a draft in the folder .tpss-studio beside the scenario, and
    written into the file, whose comments stay, when you save.
    """
    from tpss.cli.studio import open_studio

    open_studio(file, folder, port, not no_browser, new)


def warm(quiet: Quiet = False) -> None:
    """Compile all numerical kernels ahead, so that no run has to wait for them.

    Otherwise the first run compiles what every run needs, in up to a minute, and a line with coupled
    tracks, conductors of its own or stations at one busbar compiles more. Kernels are kept for this user
    and this version of TPSS; results are the same with and without.

    Exit codes: 0 done, 2 the kernels cannot be kept, 130 interrupted (what was compiled is kept).
    """
    from tpss.cli.warm import warm_up

    raise typer.Exit(warm_up(quiet))


def library(
    kind: Annotated[
        str | None,
        argument(
            metavar="KIND",
            help="locomotives, catenaries, converters, transformers, high_voltage_lines, "
            "voltage_limits, systems or wires.",
            autocompletion=complete.library_kinds,
        ),
    ] = None,
    name: Annotated[
        str | None,
        argument(
            metavar="NAME",
            help="An entry, to see all its values, their meaning and how a scenario uses it.",
            autocompletion=complete.library_names,
        ),
    ] = None,
    _library: Library = None,
) -> None:
    """List what scenarios refer to by name: trains, catenaries, converters and so on.

    Values are shown with units and sources; of a single entry, all values.
    """
    from tpss.cli.library import print_library

    print_library(kind, name)


def laws() -> None:
    """List the laws of other packages: resistances, drivers and converters that scenarios can name.

    Packages offer them as entry points "tpss.laws". Of each kind it says what such a law is given, what
    it has to find, and where a scenario names it.
    """
    from tpss.cli.laws import print_laws

    print_laws()


def schema(
    out: Annotated[
        Path | None, option(help="File to write; by default the schema is printed.")
    ] = None,
    plan: Annotated[
        bool, flag("--plan", help="The schema of plan files, in place of scenarios.")
    ] = False,
    geometry: Annotated[
        bool,
        flag("--geometry", help="The schema of conductors, for tpss line-constants."),
    ] = False,
) -> None:
    """Print the JSON Schema of scenario files, which editors use to complete and check them.

    Editors with Taplo (such as Even Better TOML) find it by the first line of a scenario,
    `#:schema scenario.schema.json`.
    """
    from tpss.cli.schema import write_schema

    if plan and geometry:
        raise typer.BadParameter("give either --plan or --geometry")
    write_schema(out, "plan" if plan else "geometry" if geometry else "scenario")
