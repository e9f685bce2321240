"""How a family of any length is laid out, so that no folder has ten thousand entries.

Shards of the store, parts of a run and shards of labels are one entry a block each, so blocks of
long families hold more variants.  Files of variants lie in folders by a variant's place alone, so
that a family which grows keeps them where they are.
"""

__all__ = ["MOST", "block_of", "home_of"]

MOST = 9_999  # entries of a folder; file systems and tools take long for more
FILES = 3  # a format may give a variant: the file, a report, a folder of airfoils


def block_of(count: int, least: int) -> int:
    """Return how many variants a block of so many has: `least`, or more by powers of two.

    >>> block_of(1000, 64), block_of(1_000_000, 64), block_of(10_000_000, 64)
    (64, 128, 1024)
    """
    size = least
    while -(-count // size) > MOST:
        size *= 2
    return size


def home_of(place: int, formats: int) -> str:
    """Return the folder, below that of all files, of a variant's files in so many formats.

    >>> home_of(999, 2), home_of(1000, 2), home_of(150, 9)
    ('', '001', '001')
    """
    together = 1000 if formats * FILES * 1000 < MOST else 100
    return f"{place // together:03d}" if place >= together else ""
