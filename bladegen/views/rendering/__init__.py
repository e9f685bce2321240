"""Scenes of blades, and VTK drawing them: in a picture, or in a window that keys command.

In comes a blade, perturbed or not; `blade_scene` makes a `scene` of plain arrays from it; out goes
what a camera sees, as PNG, as frames or in a window.  Another quantity as colour goes into
`blade_scene`, another view into `cameras`, another key into `keys`.
"""
