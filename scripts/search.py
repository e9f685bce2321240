"""Look for ten tasks in the built site as a reader would: python scripts/search.py site

Each row is what people type and the page that answers it, which must be among the first three that
the site's search finds.  The site's search is lunr; this is lunr for Python over the same index,
titles weighing as much as the site has them.
"""

import json
import sys
from pathlib import Path

from lunr import lunr

FIRST = 3  # what a reader looks at
TITLE = 1000  # times as heavy as text: mkdocs-material's own
TASKS = {
    "blade in Fluent": "systems.html",
    "STAR-CCM+": "systems.html",
    "SolidWorks": "systems.html",
    "XFOIL": "systems.html",
    "3D print a model": "systems.html",
    "OpenFOAM snappyHexMesh": "systems.html",
    "export spar caps": "structure.html",
    "twist convention": "formats.html",
    "perturbed blade back into OpenFAST": "tools.html",
    "gradient optimisation": "optimise.html",
    "structured grid CGNS": "grids.html",
    "training data for machine learning": "families.html",
}


def found(index: object, words: str) -> list[str]:
    """Return the pages that a search finds, the best first, each once."""
    pages = [hit["ref"].partition("#")[0] for hit in index.search(words.replace("+", " "))]
    return list(dict.fromkeys(pages))


def main() -> int:
    """Search for each task; 1 if one is not among the first."""
    site = Path(sys.argv[1])
    entries = json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))["docs"]
    fields = [{"field_name": "title", "boost": TITLE}, {"field_name": "text"}]
    documents = [(entry, {"boost": entry.get("boost", 1.0)}) for entry in entries]
    index = lunr(ref="location", fields=fields, documents=documents)
    missed = 0
    for words, page in TASKS.items():
        pages = found(index, words)[:FIRST]
        if page not in pages:
            sys.stderr.write(
                f"search: {words!r} finds {', '.join(pages) or 'nothing'}, should find {page}\n"
            )
            missed += 1
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
