"""What a tab of the studio shows, and what its parts do.

In come moves of sliders, clicks and keys; out go elements of the web framework: the bar, panels of
sliders, the 3D view (`stage.js`) and charts, all of them held by a `tab`.  A new button goes into
`bar`, a new panel into `panels`, a new plot over span into `charts`.
"""
