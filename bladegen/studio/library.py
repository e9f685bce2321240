"""The blades a studio may show: bundled ones, a file it was started with, and uploads.

A file's key holds its content's hash, and the definition's where a file may name others, so that a
link means the same after a restart with the same blade.  Uploads lie in the studio's temporary
folder, each in one of its key, as many as `KEPT`, and are read by the same readers as every other
file.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path, PurePath
from shutil import rmtree
from tempfile import TemporaryDirectory
from threading import Lock

from bladegen.definition.blade_definition import BladeDefinition
from bladegen.errors import FileError, StudioError, visible
from bladegen.exports.inventory import REPORT
from bladegen.families.identity import fingerprint
from bladegen.formats.airfoils import reading as airfoil_files
from bladegen.formats.bundled import bundled
from bladegen.formats.hawc2 import reading as hawc2
from bladegen.formats.openfast import reading as openfast
from bladegen.formats.openfast.model import PART_SUFFIX
from bladegen.formats.qblade import reading as qblade
from bladegen.formats.reading import SUFFIXES, holds_blade, read
from bladegen.formats.registry import FORMATS
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.studio.choices.loft import PLAIN, Loft
from bladegen.studio.model import Baseline
from bladegen.support.files import safe_stem

__all__ = ["UPLOADS", "UPLOAD_BYTES", "UPLOAD_FILES", "Entry", "Library"]

WHOLE = {s for row in FORMATS if row.alone and row.reader for s in row.reader.suffixes}
UPLOADS = tuple(dict.fromkeys([*SUFFIXES, *airfoil_files.SUFFIXES, qblade.POLAR_FILES]))
UPLOAD_BYTES = 8 * 2**20  # of a blade's files together; the largest windIO example has 0.7 MB
UPLOAD_FILES = 500  # the IEA 15 MW from HAWC2 or OpenFAST comes in 100 to 140
SHOWN = 120  # letters of what was sent that a message holds
TOGETHER = "what it names must be loaded together with it, or `bladegen convert` it to .yaml first"
KEPT = 12  # uploads and prepared blades that are kept, each


@dataclass(frozen=True)
class Entry:
    """A blade of the library.

    Parameters
    ----------
    key : str
        What links call it.
    label : str
        What people read.
    source : str
        What `bladegen.read` takes.
    named : str
        What commands call it: the bundled name, or the file as its owner named it.
    airfoils : str, optional
        The folder of its airfoil files, where the command line named one.
    """

    key: str
    label: str
    source: str
    named: str
    airfoils: str | None = None


class Library:
    """The entries of one running studio, and the blades made from them; safe between threads."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._lock = Lock()
        self._entries = {name: Entry(name, name, name, name) for name in bundled()}
        self._uploads: list[str] = []
        self._baselines: dict[tuple[str, Loft], Baseline] = {}
        self._space: ShapeSpace | None = None

    @property
    def space(self) -> ShapeSpace:
        """The modes that sliders move along."""
        if self._space is None:
            self._space = ShapeSpace.bundled()
        return self._space

    @property
    def labels(self) -> dict[str, str]:
        """What people read, by key."""
        return {key: entry.label for key, entry in self._entries.items()}

    def entry(self, key: str) -> Entry:
        """Return an entry.

        Raises
        ------
        StudioError
            If the library has none of that key.
        """
        if key not in self._entries:
            raise StudioError(
                f"blade: {key[:60]!r} is not here, there are {', '.join(self._entries)}; load its "
                "file first"
            )
        return self._entries[key]

    def add(self, source: str, airfoils: Path | None = None) -> str:
        """Add what a command line names, a bundled blade or a file; return its key.

        Raises
        ------
        FileError
            If it is no blade.
        """
        if source in self._entries:
            return source
        definition = read(source, airfoils=airfoils)
        path = Path(definition.source)
        key = _key(path.name, path.read_bytes(), _others(path, definition))
        folder = None if airfoils is None else str(airfoils)
        entry = Entry(key, visible(path.name), str(path), source, folder)
        self._prepared(entry, lambda: definition)
        self._entries[key] = entry
        return key

    def upload(self, *files: tuple[str, bytes]) -> str:
        """Add a blade that a browser sent, each file by its name and content; return its key.

        One file is the blade's, the others are airfoils and tables that it names.

        Raises
        ------
        FileError
            If they are too large or of no known format, or there is no blade or more than one.
        """
        named = {_stored(name): (_plain(name), content) for name, content in files}
        shown = ", ".join(plain for plain, _ in named.values())[:SHOWN]
        for plain, _ in named.values():
            suffix = PurePath(plain).suffix.lower()
            if suffix not in UPLOADS:
                allowed = ", ".join(UPLOADS)
                raise FileError(plain, [f"has the suffix {suffix!r}, allowed are {allowed}"])
        if sum(len(content) for _, content in files) > UPLOAD_BYTES:
            raise FileError(shown, [f"is larger than {UPLOAD_BYTES >> 20} MB"])
        if not 0 < len(named) == len(files) <= UPLOAD_FILES:
            raise FileError(
                shown, [f"got {len(files)} files, allowed are {UPLOAD_FILES} of different names"]
            )
        with TemporaryDirectory(dir=self._folder, ignore_cleanup_errors=True) as name:
            place = Path(name)
            for stored, (_, content) in named.items():
                (place / stored).write_bytes(content)
            path = _blade_among(place, shown)
            plain, content = named[path.name]
            _airfoils_apart(path, content, named)
            try:
                definition = replace(read(path), source=plain)
            except FileError as error:
                problems = [problem.replace(f"{place}/", "") for problem in error.problems]
                alone = len(files) == 1 and path.suffix.lower() not in WHOLE
                raise FileError(plain, problems + [TOGETHER] * alone) from None
            key = _key(plain, content, _others(path, definition))
            entry = Entry(key, visible(plain), str(self._folder / key / path.name), plain)
            self._prepared(entry, lambda: definition)
            with self._lock:
                if key in self._entries:
                    return key
                place.rename(self._folder / key)
                self._entries[key] = entry
                self._uploads.append(key)
                for old in self._uploads[:-KEPT]:
                    rmtree(Path(self._entries.pop(old).source).parent, ignore_errors=True)
                    for known in [known for known in self._baselines if known[0] == old]:
                        del self._baselines[known]
                del self._uploads[:-KEPT]
        return key

    def baseline(self, key: str, loft: Loft = PLAIN) -> Baseline:
        """Return an entry's blade, made as asked for, prepared."""
        entry = self.entry(key)
        return self._prepared(entry, lambda: read(entry.source, airfoils=entry.airfoils), loft)

    def _prepared(
        self, entry: Entry, defined: Callable[[], BladeDefinition], loft: Loft = PLAIN
    ) -> Baseline:
        key = entry.key, loft
        with self._lock:
            found = self._baselines.get(key)
        if found is None:
            found = Baseline(entry.key, loft.blade(defined()), self.space)
            found.at(0.5)  # so that nothing is offered that cannot be shown
            with self._lock:
                self._baselines[key] = found
                while len(self._baselines) > KEPT:
                    del self._baselines[next(iter(self._baselines))]
        return found


def _key(name: str, content: bytes, others: str = "") -> str:
    digest = sha256(content + others.encode())
    return f"{safe_stem(PurePath(name).stem)[:40]}-{digest.hexdigest()[:10]}"


def _others(path: Path, definition: BladeDefinition) -> str:
    """Return a fingerprint of a blade whose file may name others; "" if it may not."""
    if path.suffix.lower() in WHOLE:
        return ""
    return fingerprint(replace(definition, name="blade"))  # its own is the file's


def _plain(name: str) -> str:
    """Return a file's name as its owner knows it, without folders."""
    return PurePath(name.replace("\\", "/")).name[:SHOWN] or "file"


def _stored(name: str) -> str:
    """Return the name under which a file that was sent is kept."""
    plain = PurePath(_plain(name))
    return f"{safe_stem(plain.stem)}{plain.suffix.lower()}"


def _blade_among(place: Path, shown: str) -> Path:
    """Return the one file of a folder that is a blade's; a single file is.

    Lines of AeroDyn's main input and reports that bladegen wrote with a blade are none.
    """
    files = list(place.iterdir())
    whole = [path for path in files if not path.name.endswith((PART_SUFFIX, REPORT))]
    found = [path for path in whole if len(files) == 1 or holds_blade(path)]
    if len(found) != 1:
        names = ", ".join(sorted(path.name for path in found)) or "none"
        raise FileError(shown, [f"must hold one blade, got {names[:SHOWN]}"])
    return found[0]


def _airfoils_apart(path: Path, content: bytes, stored: Iterable[str]) -> None:
    """Move what is no table of the blade's into the folder in which airfoils are looked for."""
    tables = {f"{path.stem}{suffix}" for suffix in (hawc2.AE_SUFFIX, openfast.TWIST_SUFFIX)}
    folder = path.with_name("airfoils")
    for name in stored:
        if name != path.name and name not in tables and name.encode() not in content:
            folder.mkdir(exist_ok=True)
            path.with_name(name).rename(folder / name)
