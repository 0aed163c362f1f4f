"""What ``tpss report``, ``plot``, ``export`` and ``sweep --case`` do with the folder of a study."""

from pathlib import Path

from tpss.cli.plot import ALL, FORMATS, figure_bytes
from tpss.cli.terminal import tell
from tpss.errors import ResultError, StudyError, no_such
from tpss.extras import demand
from tpss.files.refusals import refuse_to_replace
from tpss.files.several import check_files, save_files
from tpss.results.contents import DATASET, REPORT, TABLES
from tpss.results.contents import FIGURES as FIGURES_FOLDER
from tpss.results.file_kinds import Kind, Spreadsheet

MANIFEST = "study.json"


def is_study(folder: Path) -> bool:
    """Whether a folder is that of a study, not of a result."""
    return (folder / MANIFEST).is_file() and not (folder / DATASET).exists()


def demand_unused(of: str, **options: object) -> None:
    """Refuse options that mean nothing there.

    Raises
    ------
    ResultError
    """
    given = [f"--{name}" for name, value in options.items() if value]
    if given:
        raise ResultError(f"{of} has no use for {' and '.join(given)}; leave it out")


def write_case(place: Path, case: int, out: Path | None, force: bool) -> None:
    """Write a case of a study, given by its file or its folder, as a scenario.

    Raises
    ------
    ScenarioError
        The study or the scenario has faults.
    StudyError, ResultError
        There is no such case, or the file cannot be written.
    """
    demand("study")
    from tpss.sweep.derive import scenario_of
    from tpss.sweep.design import design_of
    from tpss.sweep.folder import read_manifest
    from tpss.sweep.study import load_study, study_of_json

    known = study_of_json(read_manifest(place)["study"]) if place.is_dir() else None
    study = known or load_study(place)
    design = design_of(study)
    if not 0 <= case < design.cases:
        last = f"{design.cases - 1:,}"
        raise StudyError(f"{study.file.name} has no case {case}; give a number from 0 to {last}")
    target = out or Path(f"{study.file.name}-{case}.toml")
    refuse_to_replace(target, force, "a file", Path.is_file)  # before a scenario is made
    scenario_of(design, case).save(target, force=force)
    values = ", ".join(f"{name} = {value!r}" for name, value in design.values(case).items())
    tell(f"Wrote {target}: case {case}, {values}")
    tell(f"Run it with  tpss run {target}")


def export_study(
    folder: Path, kind: Kind, out: Path | None, force: bool, spreadsheet: Spreadsheet | None = None
) -> None:
    """Export the table of a study, and print where it is.

    Raises
    ------
    StudyError, ResultError
        The folder has no cases, or the file cannot be written.
    """
    demand("study")
    from tpss.results.export import contents_of, demand_package
    from tpss.sweep.outcome import load_outcome

    demand_package(kind)
    table = load_outcome(folder).table.drop(columns=["timing.ended"])
    place = folder / TABLES if out is None else out
    contents = contents_of({"cases": table}, kind, "study.xlsx", spreadsheet)
    check_files(place, contents, force)
    files = save_files(place, contents, force)
    tell(f"Wrote into {place}: {', '.join(file.name for file in files)}")


def plot_study(folder: Path, figure: str, out: Path | None, force: bool) -> None:
    """Write figures of a study, and print where they are.

    Raises
    ------
    StudyError, ResultError
        The folder has no cases, there is no such figure, or a file cannot be written.
    """
    demand("study", "figures")
    from tpss.report.render.static import render
    from tpss.sweep.figures import FIGURES, drawable
    from tpss.sweep.outcome import demand_cases, load_outcome

    if figure != ALL and figure not in FIGURES:
        problem, remedy = no_such("figure of a study", figure, [*FIGURES, ALL])
        raise ResultError(f"{figure!r}: {problem}; {remedy}")
    outcome = load_outcome(folder)
    demand_cases(outcome, folder)
    names = [name for name in drawable(outcome) if figure in (name, ALL)]
    if not names:
        raise ResultError(f"too little differs among the cases of {folder} to draw {figure}")
    suffix = out.suffix.removeprefix(".").lower() if out is not None else ""
    is_file = suffix in FORMATS
    if is_file and figure == ALL:
        raise ResultError(f"{out} is one file, and all figures need a folder; give another --out")
    place = folder / FIGURES_FOLDER if out is None else (out.parent if is_file else out)
    files = [out.name] if is_file and out is not None else [f"{name}.png" for name in names]
    check_files(place, files, force)
    contents = {
        file: figure_bytes(render(FIGURES[name](outcome)), Path(file).suffix.removeprefix("."))
        for name, file in zip(names, files, strict=True)
    }
    written = save_files(place, contents, force)
    tell(f"Wrote into {place}: {', '.join(file.name for file in written)}")


def report_study(folder: Path, out: Path | None, force: bool) -> None:
    """Write a report of a study, and print where it is.

    Raises
    ------
    StudyError, ResultError
        The folder has no cases, or the file cannot be written.
    """
    demand("study", "report")
    from tpss.sweep.report import write_study_report

    tell(f"Wrote {write_study_report(folder, out or folder / REPORT, force=force)}")
