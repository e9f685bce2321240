"""What the wind makes of blades: polars of their sections, power, loads and energy of a rotor.

In come sections in space (..., k, n, 3) [m] as blades and batches make them; out go polars
(`section_polars`, by NeuralFoil), elements of a rotor (`elements`), coefficients by blade-element
momentum theory (`momentum`, `performance`), annual energy (`energy`), and all of these for one
blade (`evaluation`).  A new figure of a rotor goes into `performance`.
"""
