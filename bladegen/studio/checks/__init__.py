"""The live checks of a blade: what is wrong, what is odd, and what comes near to being odd.

In come a batch's sections with what was measured of them; out go `scene.Check`s, good, near, odd or
bad, each with its figure.  A new check is a function in `verdicts`, and a row of the page's docs.
"""
