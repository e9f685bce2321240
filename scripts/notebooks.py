"""Notebooks in the documentation: a line ``<!-- notebook: FILE -->`` becomes the notebook's cells.

A hook of MkDocs.  Notebooks are scripts whose cells begin with ``# %%``, as Jupytext and editors
have them: cells marked ``[markdown]`` become text, others blocks of Python, and a picture that a
cell saves under a name and a title stands after it, from ``docs/images/notebook-NAME.png``.
"""

import re
from pathlib import Path

LINE = re.compile(r"^<!-- notebook: (\S+) -->$", re.MULTILINE)
CELL = re.compile(r"^# %%(.*)\n", re.MULTILINE)
PICTURE = re.compile(r'savefig\(\s*"(\w+)\.png".*?"Title": "([^"]+)"', re.DOTALL)


def on_page_markdown(markdown: str, **_: object) -> str:
    """Put the notebooks into a page."""
    return LINE.sub(lambda found: rendered(Path(found[1]).read_text(encoding="utf-8")), markdown)


def rendered(script: str) -> str:
    """Return a notebook as Markdown."""
    parts, blocks = CELL.split(script)[1:], []
    for kind, body in zip(parts[::2], parts[1::2], strict=True):
        if kind.strip() == "[markdown]":
            blocks.append(
                "\n".join(
                    line.removeprefix("#").removeprefix(" ") for line in body.strip().splitlines()
                )
            )
            continue
        blocks.append(f"```python\n{body.strip()}\n```")
        blocks += [
            f"![{title}](images/notebook-{name}.png)" for name, title in PICTURE.findall(body)
        ]
    return "\n\n".join(blocks)
