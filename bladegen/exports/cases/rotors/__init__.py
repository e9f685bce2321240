"""Cases of rotors: one blade in its sector, which turns with it, as files of OpenFOAM.

In comes a blade and how its rotor works (`operation`); out goes a folder whose `Allrun` meshes the
sector (`sector` for blockMesh, `meshing` for snappyHexMesh) and solves the flow (`dictionaries`).
"""
