"""Cases that a flow solver runs: a mesh, what flows, and the files that say how to solve it.

In comes a blade, a span fraction and what flows there; out goes a folder that OpenFOAM runs as it
is, with the commands to type.  A section's mesh is an O-grid (`outline`, `marching`, `poly_mesh`);
another solver's files are modules beside `dictionaries`, another flow one beside
`section`; a rotor, which OpenFOAM meshes, is a room of its own (`rotors`).
"""
