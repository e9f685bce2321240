"""The Grassmannian Gr(n, p), by its public name: see `bladegen.shapes.grassmann`."""

from bladegen.shapes.grassmann import *  # noqa: F403
