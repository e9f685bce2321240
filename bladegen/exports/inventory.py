"""Which files of a blade lie in a folder, and what each is made from.

Files say it themselves (`marks`); what a format has no room for stands in the report beside them,
which lists each file with its settings.
"""

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from bladegen.errors import BladegenError, Finding
from bladegen.exports import marks
from bladegen.exports.provenance import Provenance
from bladegen.support.files import content_of, digest_of, replacing

__all__ = ["REPORT", "entry_of", "list_files", "made_by", "others"]

REPORT = ".report.json"
FOLDER_REPORT = f"airfoils{REPORT}"
LARGEST_REPORT = 20_000_000  # bytes
FACTS = {  # of a `Provenance`, by what they are called in a report
    "bladegen": "version",
    "source": "source",
    "source_sha256": "sha256",
    "definition": "definition",
    "command": "command",
    "id": "id",
}


def entry_of(path: Path, made: Provenance) -> dict[str, Any]:
    """Return what a report says of a file: which it is, and what it is made from."""
    return {
        "name": path.name,
        "bytes": path.stat().st_size,
        "sha256": digest_of(path),
        **{name: getattr(made, field) for name, field in FACTS.items()},
        "settings": dict(made.settings),
    }


def list_files(folder: Path, files: Iterable[Path], made: Provenance) -> None:
    """List files that have no place for it in a report of their folder, beside those before."""
    report = folder / FOLDER_REPORT
    known = {name: told for name, told in _told(report).items() if (folder / name).is_file()}
    known |= {file.name: entry_of(file, made) for file in files}
    with replacing(report) as temporary:
        said = {"files": [known[name] for name in sorted(known)]}
        temporary.write_text(json.dumps(said, indent=2) + "\n", encoding="utf-8")


def made_by(path: Path) -> Provenance | None:
    """Return what a file is made from, by its own words or those of a report beside it.

    A report counts only for the very bytes that it lists.
    """
    made = marks.read(path)
    if made is not None and not made.is_partial:
        return made
    for report in sorted(path.parent.glob(f"*{REPORT}")):
        whole = report.name == FOLDER_REPORT
        if whole or path.name.startswith(report.name.removesuffix(REPORT)):
            told = _told(report).get(path.name)
            if told is not None and told["sha256"] == digest_of(path):
                return _provenance(told)
    return made


def others(
    folder: Path, stem: str, written: set[str], here: Callable[[Path], Provenance | None]
) -> tuple[list[dict[str, Any]], list[Finding]]:
    """Return entries of a blade's files that were there before, and of those of another build why.

    Parameters
    ----------
    folder : Path
        Where they lie.
    stem : str
        What their names begin with.
    written : set of str
        Names of files that are not asked after.
    here : callable
        From a file to what it would be made from now, None if it would not be made.
    """
    entries, findings = [], []
    for path in sorted(folder.glob(f"{stem}.*")):
        if path.name in written or path.name.endswith(REPORT) or not path.is_file():
            continue
        made, now = made_by(path), here(path)
        if made is None:
            continue
        entries.append(entry_of(path, made))
        differences = [] if now is None else made.differences(now)
        if differences:
            said = "; ".join(f"{what}: {there}, here {now_}" for what, there, now_ in differences)
            findings.append(Finding(path.name, f"is of another build: {said}"))
    return entries, findings


def _told(report: Path) -> dict[str, dict[str, Any]]:
    """Return a report's entries by name; none if it is no report of this version."""
    try:
        found = json.loads(content_of(report, LARGEST_REPORT))["files"]
        return {one["name"]: one for one in found if {"sha256", "settings", *FACTS} <= one.keys()}
    except (BladegenError, OSError, ValueError, LookupError, TypeError, AttributeError):
        return {}


def _provenance(told: dict[str, Any]) -> Provenance:
    facts = {field: str(told[name]) for name, field in FACTS.items()}
    settings = tuple((str(key), str(value)) for key, value in told["settings"].items())
    return Provenance(blade="", settings=settings, **facts)
