"""What takes longer than a frame: lift and drag, power of the rotor, structure and mass.

In comes a `question` (a blade's source and a state of it); out go `answers`, of the state beside
those of the baseline.  A process of its own gives them once a slider rests, so that the picture
does not wait for them.  A new figure goes into the module that computes it, into its answer, and
into `page.figures`.
"""
