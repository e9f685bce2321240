"""The blades a studio may show: bundled ones, a file it was started with, and uploads.

A file's key holds its content's hash, and the definition's where a file may name others, so that a
link means the same after a restart with the same blade.  Uploads lie in the studio's temporary
folder, each in one of its key, as many as `KEPT`, and are read by the same readers as every other
file.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path, PurePath
from shutil import rmtree
from threading import Lock

from bladegen.blade import Blade
from bladegen.definition import BladeDefinition
from bladegen.errors import FileError, StudioError
from bladegen.files import safe_stem
from bladegen.identity import fingerprint
from bladegen.pga import ShapeSpace
from bladegen.readers import bundled, read
from bladegen.studio.model import Baseline

__all__ = ["UPLOADS", "UPLOAD_BYTES", "Entry", "Library"]

UPLOADS = (".yaml", ".yml", ".json")  # formats that name no other files
UPLOAD_BYTES = 8 * 2**20  # the largest windIO example has 0.7 MB
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
        What `readers.read` takes.
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
        self._baselines: dict[str, Baseline] = {}
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
        entry = Entry(key, path.name, str(path), source, folder)
        self._prepared(entry, lambda: Blade.from_definition(definition))
        self._entries[key] = entry
        return key

    def upload(self, name: str, content: bytes) -> str:
        """Add a file that a browser sent; return its key.

        Raises
        ------
        FileError
            If it is too large, of a format that names other files, or no blade.
        """
        plain = PurePath(name.replace("\\", "/")).name[:120] or "file"
        suffix = PurePath(plain).suffix.lower()
        if suffix not in UPLOADS:
            raise FileError(plain, [f"has the suffix {suffix!r}, allowed are {', '.join(UPLOADS)}"])
        if len(content) > UPLOAD_BYTES:
            raise FileError(plain, [f"is larger than {UPLOAD_BYTES >> 20} MB"])
        key = _key(plain, content)
        with self._lock:
            if key in self._entries:
                return key
        path = self._folder / key / f"{safe_stem(PurePath(plain).stem)}{suffix}"
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
        try:
            definition = replace(read(path), source=plain)
            entry = Entry(key, plain, str(path), plain)
            self._prepared(entry, lambda: Blade.from_definition(definition))
        except BaseException as error:
            rmtree(path.parent)
            if isinstance(error, FileError):
                raise FileError(plain, error.problems) from None
            raise
        with self._lock:
            self._entries[key] = entry
            self._uploads.append(key)
            for old in self._uploads[:-KEPT]:
                rmtree(Path(self._entries.pop(old).source).parent, ignore_errors=True)
                self._baselines.pop(old, None)
            del self._uploads[:-KEPT]
        return key

    def baseline(self, key: str) -> Baseline:
        """Return an entry's blade, prepared."""
        entry = self.entry(key)
        return self._prepared(
            entry,
            lambda: Blade.from_definition(read(entry.source, airfoils=entry.airfoils)),
        )

    def _prepared(self, entry: Entry, make: Callable[[], Blade]) -> Baseline:
        with self._lock:
            found = self._baselines.get(entry.key)
        if found is None:
            found = Baseline(entry.key, make(), self.space)
            found.at(0.5)  # so that nothing is offered that cannot be shown
            with self._lock:
                self._baselines[entry.key] = found
                while len(self._baselines) > KEPT:
                    del self._baselines[next(iter(self._baselines))]
        return found


def _key(name: str, content: bytes, others: str = "") -> str:
    digest = sha256(content + others.encode())
    return f"{safe_stem(PurePath(name).stem)[:40]}-{digest.hexdigest()[:10]}"


def _others(path: Path, definition: BladeDefinition) -> str:
    """Return a fingerprint of a blade whose file may name others; "" if it may not."""
    if path.suffix.lower() in UPLOADS:
        return ""
    return fingerprint(replace(definition, name="blade"))  # its own is the file's
